// The actors that are there, and who flies which order: every order out has an actor that was heard
// of lately, and what is late is asked for again, of another where there is one. Decides who, never
// what: nothing here reaches the weights. Memory is bounded. Time is an argument: of a clock that does
// not go on while the learner itself is stopped. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "msgs/wire.h"
#include "training/ledger.h"

namespace fresco {

struct ActorRecord {
  int64_t last_heard_us = 0;
  int64_t sequence = -1;  ///< of its last status
  int32_t capacity = 1;
  int32_t pid = 0;
  std::string host;
  int64_t oldest_open_order = -1;
  float transitions_per_s = 0;
  std::vector<chunk_range_t> missing;
  int late_orders = 0;        ///< taken from it since its last result
  int64_t last_assigned = 0;  ///< number of the assignment: among equals, the turns go round
};

class Roster {
 public:
  /// Actors remembered at a time. Those that are gone make room for new ones.
  static constexpr size_t kMaximumActors = 4096;

  enum class Hearing {
    kHeard,
    kStale,       ///< not newer than the actor's last one: a repeated, late or replayed message
    kCrowdedOut,  ///< of a further actor while so many are there
  };

  /// Notes a status of an actor of this run, unless it is stale or crowded out.
  Hearing Hear(const actor_status_t& status, int64_t now_us);

  /// Notes that the result of an order is complete, with what `actor_id` sent.
  void Completed(int64_t index, int64_t actor_id, int64_t now_us);

  /// Assigns, assigns again what is late, and returns what is to be announced now: what is new, and
  /// what was announced a while ago and is still out.
  std::vector<order_t> DueOrders(const Ledger& ledger, int64_t now_us);

  /// Actors heard of in the last three seconds.
  int live_actors(int64_t now_us) const;
  /// Orders whose result had to be asked for again.
  int64_t late_orders() const { return late_orders_; }
  /// For people: whose result of this order is awaited, since when, and at which stage it is.
  std::string Awaited(const Order& order, int64_t now_us) const;
  /// For people, indented lines: every actor with the age of its last status and its orders.
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
  /// The actor with the most room that is not silent, another than `except` where there is one; 0: none.
  int64_t Choose(int64_t except, int64_t now_us) const;
  bool IsLate(const Assignment& assignment, int64_t now_us) const;

  std::map<int64_t, ActorRecord> actors_;
  std::map<int64_t, int> open_orders_;         // by actor; only those that have some
  std::map<int64_t, Assignment> assignments_;  // by order index
  int64_t assigned_ = 0;
  int64_t late_orders_ = 0;
  double latency_us_ = 250'000;  // of an order, exponential average
};

}  // namespace fresco
