// Messages of plain text, for tests that send some.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace fresco {

inline std::span<const std::byte> Bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

inline std::string Text(std::span<const std::byte> message) {
  return {reinterpret_cast<const char*>(message.data()), message.size()};
}

}  // namespace fresco
