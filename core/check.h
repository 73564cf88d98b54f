// Checks of what only a programmer's error can break. A failed check prints and aborts, in every
// build type. Bad input is never checked with these: it throws (error.h) or is counted.
#pragma once

namespace fresco {

[[noreturn]] void CheckFailed(const char* file, int line, const char* condition);

}  // namespace fresco

#define FRESCO_CHECK(condition)                                   \
  do {                                                            \
    if (!(condition)) [[unlikely]] {                              \
      ::fresco::CheckFailed(__FILE_NAME__, __LINE__, #condition); \
    }                                                             \
  } while (false)
