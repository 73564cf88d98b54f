// Whether this program has a sanitizer, with which everything takes ten times as long.
#pragma once

namespace fresco {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace fresco
