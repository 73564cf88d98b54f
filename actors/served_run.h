// One run while an actor serves it: its orders, the networks that they name, the flights, and the flown
// episodes that are sent again if the learner announces their orders again. Orders and episodes are kept
// within the window that the newest orders_t names, so memory is bounded. All times are microseconds.
// Actor owns one. Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "actors/network_store.h"
#include "core/memory.h"
#include "msgs/experiment.h"
#include "training/flyer.h"

namespace fresco {

class ServedRun {
 public:
  /// Sends the result of an order to the learner; `again` says whether it was sent before.
  using SendResult = std::function<void(const OrderResult&, bool again)>;

  /// Flies up to `capacity` (>= 1) orders at a time.
  ServedRun(Experiment experiment, RunIdentity identity, int capacity, SendResult send);

  RunIdentity identity() const { return identity_; }
  const World& world() const { return experiment_.world(); }
  const NetworkStore& store() const { return store_; }

  /// Notes a message of the learner: `utime` is its time by the learner's clock, `now_us` the time by
  /// a clock that stops while the process is stopped. Returns false if the message is stale, so must be
  /// dropped: it could move the window back or end the run. If the learner's clock was set back, everything
  /// is stale, and the actor joins again.
  bool Hear(int64_t utime, int64_t now_us);
  int64_t last_heard_us() const { return last_heard_us_; }
  /// The newest time of a message by the learner's clock.
  int64_t newest_utime() const { return newest_utime_; }

  /// Accepts the message's orders for this actor, and forgets orders and episodes outside of its window.
  /// Returns how many fields and orders of the message contradict the run.
  int HandleOrders(const orders_t& message, int64_t actor_id, int64_t now_us);

  /// Adds a chunk of a network: NetworkStore::Add.
  NetworkStore::Arrival AddWeights(NetworkKind kind, const weights_t& message, int64_t now_us);

  /// Starts every order for which there is room and whose networks are complete, and flies one slot of each
  /// flight. Allocates nothing after the first episodes, unless there are new orders or networks.
  void Step(int64_t now_us);
  bool Idle() const { return flyer_.Idle(); }

  /// Fills in the fields about orders and networks.
  void WriteTo(actor_status_t& status, int64_t now_us);
  /// Indented lines for people: what every order waits for, and the networks that are complete.
  std::string StateText(int64_t now_us) const;

 private:
  /// The result of an order, and when it was last sent.
  struct Flown {
    Order order;
    OrderResult result;
    int64_t sent_us = 0;
  };

  int64_t WindowEnd() const;
  void KeepWindow();
  void Forget(std::map<int64_t, Flown>::iterator first, std::map<int64_t, Flown>::iterator last);
  void Keep(const Order& order, const OrderResult& result, int64_t now_us);
  void Accept(const Order& order, int64_t now_us);
  void StartFlights();
  int64_t OldestOpenOrder() const;
  std::string WaitsFor(const Order& order) const;

  Experiment experiment_;
  RunIdentity identity_;
  int capacity_;
  SendResult send_;
  NetworkStore store_;
  Flyer flyer_;
  int64_t committed_ = 0;           // orders below are done
  std::vector<Order> waiting_;      // sorted by index: for networks or room
  bool news_ = false;               // since waiting orders were last looked at: orders, networks or room
  std::map<int64_t, Flown> flown_;  // by index
  std::vector<std::map<int64_t, Flown>::node_type> spare_;  // room of what was flown_
  int64_t last_heard_us_ = 0;
  int64_t newest_utime_ = 0;
};

/// Returns the most memory that one actor needs: if it flies all orders of the window, in `capacity` (>= 1)
/// environments. Any thread may call it.
MemoryNeed ActorMemory(const Experiment& experiment, int capacity);

}  // namespace fresco
