// Whether this program has a sanitizer, with which everything takes ten times as long.
#pragma once

namespace fresco {

#ifdef FRESCO_SANITIZED  // by cmake/FrescoTargets.cmake
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace fresco
