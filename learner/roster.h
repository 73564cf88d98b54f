// The roster knows which actors are present and decides which of them flies which order. It gives every order
// in flight to an actor that sent a status lately, and gives late orders out again, to another actor if there
// is one. It decides only who flies an order, so nothing here reaches the weights. Memory is bounded. All
// times are microseconds of a clock that stops while the learner's process is stopped
// (core/clock.h). LearnerNode owns it. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "msgs/wire.h"
#include "training/ledger.h"

namespace fresco {

/// What the roster knows of one actor, most of it from the actor's last status.
struct ActorRecord {
  int64_t last_heard_us = 0;
  int64_t sequence = -1;  ///< number of its last status
  int32_t capacity = 1;   ///< orders that it can fly at a time, 1 .. 4096
  int32_t pid = 0;
  std::string host;
  int64_t oldest_open_order = -1;  ///< index; -1: none
  float transitions_per_s = 0;
  int64_t processor_us = 0;            ///< processor time of its process
  std::vector<chunk_range_t> missing;  ///< chunks of networks that it lacks
  int late_orders = 0;                 ///< late orders that were taken from it since its last result
  int64_t last_assigned = 0;  ///< number of its latest assignment; equally loaded actors take turns by it
};

class Roster {
 public:
  /// The most actors remembered at a time. If there are as many, a new one replaces one that is
  /// gone.
  static constexpr size_t kMaximumActors = 4096;
  /// An actor gets at most so many orders for each of its environments: one to fly and one to fly next. The
  /// others wait for an actor with room, which may join later.
  static constexpr int kOrdersPerEnvironment = 2;

  enum class Hearing {
    kHeard,
    kStale,       ///< not newer than the actor's last status: a repeated, late or replayed message
    kCrowdedOut,  ///< from a new actor, but kMaximumActors are present
  };

  /// Reads a status of an actor of this run. A status that is stale or crowded out changes nothing.
  Hearing Hear(const actor_status_t& status, int64_t now_us);

  /// Notes that the result of order `index` is complete; `actor_id` sent its last missing part.
  void Completed(int64_t index, int64_t actor_id, int64_t now_us);

  /// Gives new and late orders to actors. Returns the orders to announce now: those just given out, and those
  /// that were announced 60 ms ago or earlier and have no complete result yet. Returns none while all actors
  /// are silent.
  std::vector<order_t> DueOrders(const Ledger& ledger, int64_t now_us);

  /// The number of actors that sent a status in the last three seconds.
  int live_actors(int64_t now_us) const;
  /// How often a late order was given out again.
  int64_t late_orders() const { return late_orders_; }
  /// Processor time that all actors took between their first and their last statuses, microseconds.
  int64_t processor_us() const { return processor_us_; }
  /// A text for people: which actor's result of this order is awaited, since when, and what the actor is
  /// doing.
  std::string Awaited(const Order& order, int64_t now_us) const;
  /// Indented lines for people: every actor, the age of its last status, and its orders.
  std::string StateText(int64_t now_us) const;

 private:
  struct Assignment {
    int64_t actor_id = 0;
    int32_t attempt = 0;
    int64_t assigned_us = 0;
    int64_t announced_us = 0;
  };

  bool MakeRoom(int64_t now_us);
  bool IsSilent(int64_t actor_id, int64_t now_us) const;
  bool AllSilent(int64_t now_us) const;
  void Assign(Assignment& assignment, int64_t actor_id, int64_t now_us);
  void Release(int64_t actor_id);
  std::string LastHeard(int64_t now_us) const;
  /// Returns the least loaded actor that is not silent and has room; `except` only if there is no other. 0:
  /// there is none.
  int64_t Choose(int64_t except, int64_t now_us) const;
  bool IsLate(const Assignment& assignment, int64_t now_us) const;

  std::map<int64_t, ActorRecord> actors_;
  std::map<int64_t, int> open_orders_;         // by actor id; only actors that have some
  std::map<int64_t, Assignment> assignments_;  // by order index
  int64_t assigned_ = 0;
  int64_t late_orders_ = 0;
  int64_t processor_us_ = 0;
  double latency_us_ = 250'000;  // from giving an order out to its result, exponential average
};

}  // namespace fresco
