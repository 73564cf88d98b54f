#include "msgs/channels.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"

namespace fresco {

Channels ChannelsWithPrefix(const std::string& prefix) {
  constexpr size_t kMaximumLength = 40;
  const bool valid = std::all_of(prefix.begin(), prefix.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  if (prefix.empty() || prefix.size() > kMaximumLength || !valid) {
    throw UsageError(
        "run.channel_prefix: \"" + prefix +
        "\" is not a channel prefix; allowed: 1 to 40 letters, digits, '_' and '-', e.g. FRESCO");
  }
  return {prefix + "_RUN",
          prefix + "_ORDERS",
          prefix + "_TRANSITIONS",
          prefix + "_WEIGHTS_CURRENT",
          prefix + "_WEIGHTS_TARGET",
          prefix + "_ACTOR_STATUS",
          prefix + "_LEARNER_STATUS",
          prefix + "_WORLD",
          prefix + "_SCENARIO",
          prefix + "_FLIGHT",
          prefix + "_PROBE",
          prefix + "_ECHO"};
}

}  // namespace fresco
