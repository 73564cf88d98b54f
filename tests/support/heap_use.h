// How much of the heap something takes, by glibc's own count: for tests of functions that foretell it. Not
// with a sanitizer, which has a heap of its own.
#pragma once

#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdint>

#include "tests/support/sanitized.h"

namespace fresco {

/// Bytes of all blocks that are in use now, with what glibc needs for them.
inline int64_t HeapUse() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<int64_t>(info.uordblks + info.hblkhd);
}

/// Skips its tests with a sanitizer.
class HeapUseTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) {
      GTEST_SKIP() << "a sanitizer has a heap of its own";
    }
  }
};

/// What `make` leaves on the heap. What it returns lives while that is counted.
template <class Make>
int64_t HeapUseOf(Make make) {
  const int64_t before = HeapUse();
  [[maybe_unused]] const auto made = make();
  return HeapUse() - before;
}

}  // namespace fresco
