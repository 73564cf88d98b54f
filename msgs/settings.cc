#include "msgs/settings.h"

#include <charconv>

#include "core/error.h"

namespace fresco {

Settings ParseSettings(const std::vector<std::string>& arguments) {
  Settings settings;
  for (const std::string& argument : arguments) {
    const size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--set: expected path=value, e.g. schedule.seed=2; found \"" + argument + "\"");
    }
    settings.emplace_back(argument.substr(0, equals), argument.substr(equals + 1));
  }
  return settings;
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
