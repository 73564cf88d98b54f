// The names of Fresco's LCM channels. msgs/README.md says what each one carries. Pure functions; any thread
// may call them.
#pragma once

#include <string>

namespace fresco {

/// The full name of every channel, prefix included ("FRESCO_RUN").
struct Channels {
  std::string run;
  std::string orders;
  std::string transitions;
  std::string weights_current;
  std::string weights_target;
  std::string actor_status;
  std::string learner_status;
  std::string world;
  std::string scenario;
  std::string flight;
  std::string probe;
  std::string echo;
};

inline constexpr char kDefaultChannelPrefix[] = "FRESCO";

/// Returns the channel names prefix + "_RUN" and so on. Throws UsageError if the prefix is empty, is longer
/// than 40 characters, or has a character other than a letter, a digit, '_' or '-'.
Channels ChannelsWithPrefix(const std::string& prefix);

}  // namespace fresco
