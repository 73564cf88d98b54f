// An order tells an actor which episode to fly; a result brings back what was flown for it. Both travel in
// messages that fit one Ethernet frame each. Plain values; pure functions, which any thread may call.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "msgs/proto/experiment.pb.h"
#include "msgs/wire.h"
#include "worlds/episode.h"

namespace fresco {

/// A training episode explores and goes into the replay memory; an evaluation is greedy and does not.
enum class OrderKind : int8_t { kTrain = 0, kEvaluate = 1 };

/// Every input that decides the transitions of an episode.
struct Order {
  int64_t index = 0;                   ///< position in the run's sequence of orders, 0 .. 2^32 - 1
  OrderKind kind = OrderKind::kTrain;  ///< train or evaluate
  double epsilon = 0;                  ///< probability of a random action, 0 .. 1; 0 for an evaluation
  int32_t search_width = 0;            ///< of the beam search (training/beam_search.h); 0: none
  /// The first transition whose action the search chooses, 0 .. longest episode - 1. Before it, the episode
  /// explores with epsilon, behind it not at all.
  int32_t search_from = 0;
  uint64_t seed = 0;            ///< of the episode: where it begins and how it explores
  int32_t current_version = 0;  ///< version of the network that chooses the actions, >= 0
  int32_t target_version = 0;   ///< version of the network used in the temporal-difference errors, >= 0
  bool operator==(const Order&) const = default;
};

/// The largest number of orders in flight in a run: schedule.window training orders, and at most one
/// evaluation for each of them.
inline int64_t MaximumOrdersInFlight(const proto::Schedule& schedule) {
  return int64_t{schedule.window()} * (1 + int64_t{schedule.evaluation_episodes()});
}

/// Whether a run with this schedule has orders that search so, or the order does not search.
bool SearchFits(const Order& order, const proto::Schedule& schedule, int longest_episode);

/// Which of the two networks is meant.
enum class NetworkKind : int8_t { kCurrent = 0, kTarget = 1 };

/// The result of an order: its complete episode, or a part of it, as one message holds: consecutive
/// transitions, with all fields of their states or consecutive ones of these.
struct OrderResult {
  int64_t order_index = 0;
  uint64_t seed = 0;             ///< the order's
  int32_t first_transition = 0;  ///< position of the first of them in the order's episode, 0, 1, ..
  int32_t first_field = 0;       ///< position of the first field of episode.states in a state
  Episode episode;
  std::vector<float> td_errors;  ///< temporal-difference error of each transition
};

/// The message for an order that `actor_id` (not 0) shall fly; `attempt` >= 0 counts how often the order was
/// given out before.
order_t ToWire(const Order& order, int64_t actor_id, int32_t attempt);

/// Reads an order from a message. Returns false if a value is out of range; `order` is then unspecified.
bool FromWire(const order_t& message, Order& order);

/// How an episode is cut into messages: transitions in each, and fields of their states in each.
struct MessageLayout {
  int transitions = 0;  ///< 1 or more; 1 if a message does not have all fields
  int fields = 0;       ///< all, unless two states are too long for one message
  bool operator==(const MessageLayout&) const = default;
};
/// For states of `state_size` fields, 1 to kMaximumStateSize, and 1 to kMaximumActions `actions`.
MessageLayout LayoutOf(int state_size, int actions);
inline MessageLayout LayoutOf(const World& world) {
  return LayoutOf(world.state_size(), world.actions());
}

/// Splits a complete result into messages, and calls `send` with each, first transitions first. They have no
/// run and no time yet (MessageBus::Publish). `send` may change the message, which is valid during the call.
void SplitResult(const World& world, const OrderResult& result, int64_t actor_id,
                 const std::function<void(transitions_t&)>& send);

/// Reads the part of a result that a message holds. Returns false if sizes or actions do not fit the world,
/// or a value is not finite; `result` is then unspecified.
bool FromWire(const World& world, const transitions_t& message, OrderResult& result);

/// The memory of the longest result in this world, the object itself included, bytes.
int64_t LongestResultBytes(const World& world);

}  // namespace fresco
