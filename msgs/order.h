// An order: which episode to fly, and everything that its transitions follow from. Plain values.
#pragma once

#include <cstdint>

#include "fresco/order_t.hpp"

namespace fresco {

enum class OrderKind : int8_t { kTrain = 0, kEvaluate = 1 };

struct Order {
  int64_t index = 0;  ///< position in the run's sequence of orders: 0, 1, ..; no random draw depends on it
  OrderKind kind = OrderKind::kTrain;
  double epsilon = 0;  ///< probability of a random action, in [0, 1]; 0 for an evaluation
  uint64_t seed = 0;   ///< of the episode's random streams; an evaluation draws nothing
  int32_t current_version = 0;
  int32_t target_version = 0;
  bool operator==(const Order&) const = default;
};

/// The most orders that a run with this window has in flight: every training order of the window can have an
/// evaluation before it.
inline int64_t MaximumOrdersInFlight(int32_t window) {
  return 2 * int64_t{window};
}

/// Which of the two networks a version is of.
enum class NetworkKind : int8_t { kCurrent = 0, kTarget = 1 };

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

/// False where a value is out of range.
inline bool FromWire(const order_t& wire, Order& order) {
  order = {wire.index,           static_cast<OrderKind>(wire.kind),
           wire.epsilon,         static_cast<uint64_t>(wire.seed),
           wire.current_version, wire.target_version};
  return wire.index >= 0 && wire.index < (int64_t{1} << 32) && (wire.kind == 0 || wire.kind == 1) &&
         wire.epsilon >= 0 && wire.epsilon <= 1 && wire.current_version >= 0 && wire.target_version >= 0 &&
         wire.attempt >= 0;
}

}  // namespace fresco
