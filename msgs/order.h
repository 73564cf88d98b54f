// An order tells an actor which episode to fly; a result brings back what was flown for it. Both travel in
// messages that fit one Ethernet frame each. Plain values; pure functions, which any thread may call.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "msgs/wire.h"
#include "worlds/uav/episode.h"

namespace fresco {

/// A training episode explores and goes into the replay memory; an evaluation is greedy and does not.
enum class OrderKind : int8_t { kTrain = 0, kEvaluate = 1 };

/// Every input that decides the transitions of an episode.
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

/// The result of an order: its complete episode, or consecutive transitions of it, as one message holds.
struct OrderResult {
  int64_t order_index = 0;
  int32_t first_transition = 0;  ///< position of the first of them in the order's episode, 0 .. T - 2
  Episode episode;
  std::vector<float> td_errors;  ///< temporal-difference error of each transition
};

/// The message for an order that `actor_id` (not 0) shall fly; `attempt` >= 0 counts how often the order was
/// given out before.
order_t ToWire(const Order& order, int64_t actor_id, int32_t attempt);

/// Reads an order from a message. Returns false if a value is out of range; `order` is then unspecified.
bool FromWire(const order_t& message, Order& order);

/// How many transitions fit one message for this many sensors; at least 1 for up to kMaximumSensors.
int TransitionsPerMessage(int sensors);

/// Splits a complete result into messages, and calls `send` with each, first transitions first. They have no
/// run and no time yet (MessageBus::Publish).
void SplitResult(const World& world, const OrderResult& result, int64_t actor_id,
                 const std::function<void(const transitions_t&)>& send);

/// Reads the part of a result that a message holds. Returns false if sizes, actions, cells or ages do not fit
/// the world, or a value is not finite; `result` is then unspecified.
bool FromWire(const World& world, const transitions_t& message, OrderResult& result);

/// The memory of the longest result in this world, the object itself included, bytes.
int64_t LongestResultBytes(const World& world);

}  // namespace fresco
