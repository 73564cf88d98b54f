// Collects what logs contain in one pass: channels, runs, episodes, actors, gaps. It decodes only what it
// needs, and no networks. Its memory does not depend on the size of the logs. No I/O. Only one thread may use
// an object.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "bus/bus.h"
#include "logs/episode_coverage.h"
#include "logs/interval_set.h"
#include "msgs/message_decoder.h"
#include "msgs/message_peek.h"

namespace fresco {

struct ChannelTraffic {
  std::string type;           ///< a Fresco type such as "run_t"; or "foreign" and the fingerprint; or "mixed"
  int64_t events = 0;         ///< number of messages
  int64_t message_bytes = 0;  ///< their size in all
  int64_t damaged = 0;        ///< messages of a Fresco type that do not decode; networks are not checked
};

struct RunTraffic {
  uint32_t config_hash = 0;
  IntervalSet config_parts{1024};      ///< numbers of the recorded parts of the configuration
  int32_t config_part_count = 0;       ///< number of all its parts; 0 if no run_t was recorded
  bool finished = false;               ///< the learner announced the end of the run
  std::optional<int64_t> first_order;  ///< lowest index of a recorded order; none: no order was recorded
  int64_t last_order = -1;             ///< highest index of a recorded order
  int64_t committed_orders = 0;
  EpisodeCoverage episodes;
  std::set<int64_t> actors;                        ///< ids of the actors that sent transitions
  std::optional<learner_status_t> learner_status;  ///< the last one

  /// Whether every part of the configuration was recorded.
  bool config_known() const { return config_part_count > 0 && config_parts.count() == config_part_count; }
  /// The number of orders of which no transition was recorded.
  int64_t orders_without_transitions() const;
};

struct ActorTraffic {
  std::string host;
  int32_t pid = 0;
  int64_t statuses = 0;
  IntervalSet sequences{1024};  ///< numbers of its recorded statuses; missing ones were lost
};

class LogSummary {
 public:
  /// Adds an event. Call it for every event, in order.
  void Take(const LcmEvent& event);

  int64_t events() const { return events_; }
  /// Times of the first and the last event, microseconds since the epoch; 0 if there is none.
  int64_t begin_utime() const { return begin_utime_; }
  int64_t end_utime() const { return end_utime_; }
  double duration_s() const { return 1e-6 * static_cast<double>(end_utime_ - begin_utime_); }
  const std::map<std::string, ChannelTraffic, std::less<>>& channels() const { return channels_; }
  const std::map<int64_t, RunTraffic>& runs() const { return runs_; }
  const std::map<int64_t, ActorTraffic>& actors() const { return actors_; }
  int64_t foreign_messages() const { return foreign_; }
  int64_t damaged_messages() const { return damaged_; }
  /// The number of messages that were left out of the tables because these have at most 4,096 channels, runs
  /// and actors.
  int64_t beyond_limits() const { return beyond_limits_; }

 private:
  ChannelTraffic* ChannelOf(std::string_view name);
  template <class Record>
  Record* RecordOf(std::map<int64_t, Record>& records, int64_t id);
  bool TakeMessage(std::span<const std::byte> message);
  void Take(const TransitionsHeader& header);
  void Take(const run_t& message);
  void Take(const orders_t& message);
  void Take(const actor_status_t& message);
  void Take(const learner_status_t& message);
  template <class Message>
  void Take(const Message&) {}  // other messages say nothing about runs or actors

  int64_t events_ = 0;
  int64_t begin_utime_ = 0;
  int64_t end_utime_ = 0;
  std::map<std::string, ChannelTraffic, std::less<>> channels_;
  std::map<int64_t, RunTraffic> runs_;
  std::map<int64_t, ActorTraffic> actors_;
  int64_t foreign_ = 0;
  int64_t damaged_ = 0;
  int64_t beyond_limits_ = 0;
  MessageDecoder decoder_;
};

}  // namespace fresco
