// An order tells an actor which episode to fly. It holds every input that decides the episode's transitions.
// Plain values; pure functions, which any thread may call.
#pragma once

#include <cstdint>

#include "fresco/order_t.hpp"

namespace fresco {

/// A training episode explores and goes into the replay memory; an evaluation is greedy and does not.
enum class OrderKind : int8_t { kTrain = 0, kEvaluate = 1 };

struct Order {
  int64_t index = 0;                   ///< position in the run's sequence of orders, 0 .. 2^32 - 1
  OrderKind kind = OrderKind::kTrain;  ///< train or evaluate
  double epsilon = 0;                  ///< probability of a random action, 0 .. 1; 0 for an evaluation
  uint64_t seed = 0;                   ///< seed of the episode's random draws; an evaluation draws nothing
  int32_t current_version = 0;         ///< version of the network that chooses the actions, >= 0
  int32_t target_version = 0;  ///< version of the network used in the temporal-difference errors, >= 0
  bool operator==(const Order&) const = default;
};

/// The largest number of orders in flight in a run whose schedule.window is `window` (>= 1): `window`
/// training orders, and at most one evaluation for each of them.
inline int64_t MaximumOrdersInFlight(int32_t window) {
  return 2 * int64_t{window};
}

/// Which of the two networks is meant.
enum class NetworkKind : int8_t { kCurrent = 0, kTarget = 1 };

/// The message for an order that `actor_id` (not 0) shall fly; `attempt` >= 0 counts how often the order was
/// given out before.
inline order_t ToWire(const Order& order, int64_t actor_id, int32_t attempt) {
  order_t wire{};
  wire.index = order.index;
  wire.actor_id = actor_id;
  wire.attempt = attempt;
  wire.kind = static_cast<int8_t>(order.kind);
  wire.epsilon = order.epsilon;
  wire.seed = static_cast<int64_t>(order.seed);
  wire.current_version = order.current_version;
  wire.target_version = order.target_version;
  return wire;
}

/// Reads an order from a message. Returns false if a value is out of range; `order` is then of no use.
inline bool FromWire(const order_t& wire, Order& order) {
  order = {wire.index,           static_cast<OrderKind>(wire.kind),
           wire.epsilon,         static_cast<uint64_t>(wire.seed),
           wire.current_version, wire.target_version};
  return wire.index >= 0 && wire.index < (int64_t{1} << 32) && (wire.kind == 0 || wire.kind == 1) &&
         wire.epsilon >= 0 && wire.epsilon <= 1 && wire.current_version >= 0 && wire.target_version >= 0 &&
         wire.attempt >= 0;
}

}  // namespace fresco
