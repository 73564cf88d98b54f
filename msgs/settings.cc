#include "msgs/settings.h"

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

}  // namespace fresco
