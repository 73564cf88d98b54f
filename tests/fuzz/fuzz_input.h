// What fuzz targets share: how an input is taken apart, and the trailer that gets it past the CRC.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/bytes.h"
#include "core/error.h"
#include "msgs/wire.h"

namespace fresco {

inline std::string_view TextOf(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The encoding with the trailer that belongs behind it: what a hostile sender would send. A buffer of
/// exactly its size, so that the sanitizer sees every read beyond it.
inline std::vector<std::byte> WithTrailer(std::span<const std::byte> encoding) {
  std::vector<std::byte> bytes(encoding.begin(), encoding.end());
  const uint32_t crc = Crc32c(encoding);
  for (const int shift : {24, 16, 8, 0}) {
    bytes.push_back(static_cast<std::byte>(crc >> shift));
  }
  bytes.shrink_to_fit();
  return bytes;
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
