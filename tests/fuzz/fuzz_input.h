// What fuzz targets share: an input as text, and which exceptions are allowed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "tests/msgs/message_samples.h"

namespace fresco {

inline std::string_view TextOf(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Whether it returns; an Error is the allowed way to refuse, any other exception ends the fuzzer.
template <class Callable>
bool Accepts(Callable&& callable) {
  try {
    callable();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace fresco
