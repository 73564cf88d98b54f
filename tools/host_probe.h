// Asks the actors on the bus for answers to a series of messages, to learn what the network carries between
// this host and theirs, and how far their clocks are apart: for `fresco doctor --hosts`. Used by the main
// thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/open_bus.h"

namespace fresco {

struct ProbeOptions {
  std::string lcm_url;
  std::string channel_prefix;
  KeyFile key_file;
  int messages_per_s = 1000;  ///< as large as those of a training
  double seconds = 2;
};

/// An actor that is heard.
struct ProbedActor {
  std::string host;
  int32_t pid = 0;
  int received = 0;          ///< messages of this host that it heard; 0: it does not answer
  int answers = 0;           ///< of its answers, one a message, those that this host heard
  double round_trip_ms = 0;  ///< the shortest
  /// Its clock minus this host's, seconds; uncertain by half the round trip.
  double clock_ahead_s = 0;
};

struct ProbeResult {
  int sent = 0;
  double sent_per_s = 0;
  std::vector<ProbedActor> actors;  ///< by host and process id
};

/// Sends the series and waits half a second for the last answers. Throws as OpenBus does.
ProbeResult ProbeActors(const ProbeOptions& options);

}  // namespace fresco
