#include "core/identifier.h"

#include <fmt/format.h>

#include <charconv>
#include <random>

#include "core/error.h"

namespace fresco {

int64_t DrawIdentifier() {
  std::random_device device;
  return static_cast<int64_t>(((uint64_t{device()} << 32) ^ device()) & INT64_MAX) | 1;
}

std::string IdentifierText(int64_t id) {
  return fmt::format("{:016x}", static_cast<uint64_t>(id));
}

int64_t ParseRunId(const std::string& text) {
  uint64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
  if (error != std::errc() || end != text.data() + text.size() || id == 0) {
    throw UsageError("--run-id: expected 1 to 16 hexadecimal digits, not all 0; found \"" + text + "\"");
  }
  return static_cast<int64_t>(id);
}

}  // namespace fresco
