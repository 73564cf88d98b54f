// Collects what logs contain, and shows it (`fresco log info`): channels, runs, episodes, actors, gaps. No
// I/O. Only one thread may use an object.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "bus/bus.h"
#include "logs/coverage.h"
#include "logs/merged_event_logs.h"
#include "msgs/message_decoder.h"
#include "msgs/run_announcements.h"

namespace fresco {

struct ChannelTraffic {
  std::string type;           ///< a Fresco type such as "run_t"; or "foreign" and the fingerprint; or "mixed"
  int64_t events = 0;         ///< number of messages
  int64_t message_bytes = 0;  ///< their size in all
  int64_t damaged = 0;        ///< messages of a Fresco type that do not decode; networks are not checked
};

struct RunTraffic {
  uint32_t config_hash = 0;
  RunAnnouncements announcements;  ///< the parts of its configuration that were recorded
  bool config_known = false;       ///< whether all of them were recorded
  bool finished = false;           ///< the learner announced the end of the run
  std::optional<Interval> orders;  ///< lowest and highest index of the recorded orders; none: there are none
  int64_t committed_orders = 0;
  /// Messages that a transition takes, and fields of its states in each but the last: more than one, and
  /// fewer than all, if two states are too long for one message. FRESCO_WORLD says so.
  int64_t parts = 1;
  int64_t fields_of_part = 0;
  /// Of parts of transitions. Before FRESCO_WORLD, the first part counts as the whole transition.
  EpisodeCoverage episodes;
  std::set<int64_t> actors;                        ///< ids of the actors that sent transitions
  std::optional<learner_status_t> learner_status;  ///< the last one

  /// The number of orders of which no transition was recorded.
  int64_t orders_without_transitions() const;
  /// Counts in transitions: the recorded parts make up so many (rounded down), the missing parts of
  /// incomplete episodes belong to so many at least (rounded up), and so many were recorded again (rounded
  /// down).
  int64_t transitions() const { return episodes.transitions() / parts; }
  int64_t missing_transitions() const { return (episodes.missing_transitions() + parts - 1) / parts; }
  int64_t repeated_transitions() const { return episodes.repeated_transitions() / parts; }
};

struct ActorTraffic {
  std::string host;
  int32_t pid = 0;
  int64_t statuses = 0;
  IntervalSet sequences{1024};  ///< numbers of its recorded statuses; missing ones were lost
};

/// Sums up logs in one pass. It decodes only what it needs, and no networks. Its memory does not depend
/// on the size of the logs.
class LogSummary {
 public:
  /// Adds an event. Call it for every event, in order.
  void Take(const LcmEvent& event);

  int64_t events() const { return events_; }
  /// Time of the first event, microseconds since the epoch; 0 if there is none.
  int64_t begin_utime() const { return begin_utime_; }
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
  template <class Records, class Key>
  typename Records::mapped_type* RecordOf(Records& records, Key key);
  RunTraffic* RunOf(RunIdentity identity);
  bool TakeMessage(std::span<const std::byte> message);
  void Take(const TransitionsHeader& header);
  void Take(const run_t& message);
  void Take(const world_t& message);
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

/// Returns a text for people: channels, runs and actors as tables, and what is missing or damaged.
std::string LogSummaryText(const LogSummary& summary, const MergedEventLogs::Totals& totals);

/// Returns a JSON object with events, bytes, begin_utime, duration_s, damaged_bytes, torn_bytes,
/// foreign_messages, damaged_messages and beyond_limits, and with channels, runs and actors as lists of
/// objects.
std::string LogSummaryJson(const LogSummary& summary, const MergedEventLogs::Totals& totals);

}  // namespace fresco
