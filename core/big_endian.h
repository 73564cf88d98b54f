// Numbers as LCM writes them, in messages, logs and packets. Pure.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fresco {

/// The unsigned number in the first sizeof(Unsigned) bytes, most significant first.
template <class Unsigned>
Unsigned ReadBigEndian(const std::byte* bytes) {
  Unsigned value = 0;
  for (size_t i = 0; i < sizeof(Unsigned); ++i) {
    value = static_cast<Unsigned>(uint64_t{value} << 8 | std::to_integer<Unsigned>(bytes[i]));
  }
  return value;
}

}  // namespace fresco
