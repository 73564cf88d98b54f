// What can be seen of runs on the bus, as text: for `fresco watch`. It only listens. One thread at a time may
// use an object.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "msgs/channels.h"
#include "msgs/message_decoder.h"
#include "msgs/world_messages.h"

namespace fresco {

class RunWatch {
 public:
  explicit RunWatch(const Channels& channels) : channels_(channels) {}

  /// Takes a message from any channel. `now_us` is the monotonic clock.
  void Add(const LcmEvent& event, int64_t now_us);

  /// Whether a learner was heard.
  bool HasRun() const;

  /// Describes every run: its learner's progress, then a line for each actor. Rates of traffic are those
  /// since the last call. Forgets whom it has not heard for ten seconds.
  std::string Text(int64_t now_us);

 private:
  struct WatchedActor {
    actor_status_t status{};
    int64_t heard_us = 0;
  };
  struct WatchedRun {
    std::optional<learner_status_t> learner;
    int64_t heard_us = 0;  // the learner
    WorldNamesReader world;
    std::map<int64_t, WatchedActor> actors;
    int64_t network_bytes = 0;
  };
  static constexpr size_t kMaximumRuns = 32;      // a flood of false messages takes no more memory
  static constexpr size_t kMaximumActors = 1000;  // of a run

  /// The run; null if there are too many.
  WatchedRun* RunOf(int64_t run_id);
  void Forget(int64_t now_us);
  std::string TextOf(int64_t run_id, const WatchedRun& run, double seconds, int64_t now_us) const;

  Channels channels_;
  MessageDecoder decoder_;
  std::map<int64_t, WatchedRun> runs_;
  int64_t messages_ = 0;
  int64_t damaged_ = 0;
  std::optional<int64_t> since_us_;
};

}  // namespace fresco
