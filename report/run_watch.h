// What can be seen of runs on the bus, as text: for `fresco watch` and for `fresco train` on a terminal. It
// only listens. One thread at a time may use an object.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "core/live_line.h"
#include "msgs/channels.h"
#include "msgs/message_decoder.h"
#include "msgs/run_announcements.h"
#include "msgs/world_messages.h"
#include "report/text_curve.h"

namespace fresco {

class RunWatch {
 public:
  explicit RunWatch(const Channels& channels) : channels_(channels) {}
  /// Watches one run, and does not tell of the traffic as a whole: it needs NeededChannels only.
  RunWatch(const Channels& channels, int64_t run_id) : channels_(channels), only_run_(run_id) {}

  /// The channels with what is told of a run.
  std::vector<std::string> NeededChannels() const;

  /// Takes a message from any channel. `now_us` is the monotonic clock.
  void Add(const LcmEvent& event, int64_t now_us);

  /// Whether a learner was heard.
  bool HasRun() const;

  /// Describes every run: its learner's progress beside the world's reference policies and the optimum, the
  /// learning curve as far as it was heard, and a line for each actor. Rates of traffic are those since the
  /// last call. Forgets whom it has not heard for ten seconds.
  std::string Text(int64_t now_us);

 private:
  struct WatchedActor {
    actor_status_t status{};
    int64_t heard_us = 0;
  };
  struct WatchedRun {
    std::optional<learner_status_t> learner;
    int64_t heard_us = 0;  // the learner
    TimeLeft time_left_estimate;
    std::string time_left;
    RunAnnouncements announcements;
    bool announced = false;  // all parts have come
    std::string references;  // the scores of the world's reference policies, as text
    std::vector<TextCurvePoint> evaluations;
    WorldNamesReader world;
    std::map<int64_t, WatchedActor> actors;
    int64_t network_bytes = 0;
  };
  static constexpr size_t kMaximumRuns = 32;      // a flood of false messages takes no more memory
  static constexpr size_t kMaximumActors = 1000;  // of a run

  static constexpr size_t kMaximumEvaluations = 4096;  // of a run

  static void AddAnnouncement(const run_t& message, WatchedRun& run);
  static void AddStatus(learner_status_t status, int64_t now_us, WatchedRun& run);
  /// The run; null if there are too many.
  WatchedRun* RunOf(int64_t run_id);
  void Forget(int64_t now_us);
  std::string TextOf(int64_t run_id, const WatchedRun& run, double seconds, int64_t now_us) const;

  Channels channels_;
  std::optional<int64_t> only_run_;
  MessageDecoder decoder_;
  std::map<int64_t, WatchedRun> runs_;
  int64_t messages_ = 0;
  int64_t damaged_ = 0;
  std::optional<int64_t> since_us_;
};

}  // namespace fresco
