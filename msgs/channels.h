// The names of Fresco's channels. See msgs/README.md for what goes over each.
#pragma once

#include <string>

namespace fresco {

struct Channels {
  std::string run;
  std::string orders;
  std::string transitions;
  std::string weights_current;
  std::string weights_target;
  std::string actor_status;
  std::string learner_status;
  std::string scenario;
  std::string flight;
};

inline constexpr char kDefaultChannelPrefix[] = "FRESCO";

/// prefix + "_RUN" and so on. Throws UsageError where the prefix is empty, longer than 40 characters
/// or has other characters than letters, digits, '_' and '-'.
Channels ChannelsWithPrefix(const std::string& prefix);

}  // namespace fresco
