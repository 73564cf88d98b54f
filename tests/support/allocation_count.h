// Counts every allocation of the program that it is linked into, by taking the place of malloc: for
// tests that a loop makes no use of the heap. Not with a sanitizer, which
// takes malloc's place itself.
#pragma once

#include <cstdint>

namespace fresco {

/// Allocations of all threads since the program began.
int64_t AllocationCount();

}  // namespace fresco
