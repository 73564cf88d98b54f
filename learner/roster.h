// The actors that are there, and who flies which order: every order out has an actor that was heard
// of lately, and what is late is asked for again, of another where there is one. Decides who, never
// what: nothing here reaches the weights. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "learner/ledger.h"
#include "msgs/wire.h"

namespace fresco {

struct ActorRecord {
  int64_t last_heard_us = 0;
  int32_t capacity = 1;
  int32_t pid = 0;
  std::string host;
  float transitions_per_s = 0;
};

class Roster {
 public:
  /// Notes a status of an actor of this run.
  void Hear(const actor_status_t& status, int64_t now_us);

  /// Notes that the result of an order is complete.
  void Completed(int64_t index, int64_t now_us);

  /// Assigns, assigns again what is late, and returns what is to be announced now: what is new, and
  /// what was announced a while ago and is still out.
  std::vector<order_t> DueOrders(const Ledger& ledger, int64_t now_us);

  int live_actors() const { return static_cast<int>(actors_.size()); }
  /// Orders whose result had to be asked for again.
  int64_t late_orders() const { return late_orders_; }
  /// For people: whose result of this order is awaited, and since when.
  std::string Awaited(int64_t index, int64_t now_us) const;

 private:
  struct Assignment {
    int64_t actor_id = 0;
    int32_t attempt = 0;
    int64_t assigned_us = 0;
    int64_t announced_us = 0;
  };

  void ForgetGoneActors(int64_t now_us);
  bool IsSilent(int64_t actor_id, int64_t now_us) const;
  /// The actor with the most room that is not silent, another than `except` where there is one; 0: none.
  int64_t Choose(int64_t except, int64_t now_us) const;
  bool IsLate(const Assignment& assignment, int64_t now_us) const;

  std::map<int64_t, ActorRecord> actors_;
  std::map<int64_t, int> open_orders_;         // by actor
  std::map<int64_t, Assignment> assignments_;  // by order index
  int64_t late_orders_ = 0;
  double latency_us_ = 250'000;  // of an order, exponential average
};

}  // namespace fresco
