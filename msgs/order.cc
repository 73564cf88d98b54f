#include "msgs/order.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace fresco {
namespace {

constexpr int FittingTransitions(int sensors) {
  const auto mask_size = static_cast<size_t>(kMoves * (sensors + 1) + 7) / 8;
  size_t fitting = 0;
  while (Description<transitions_t>::EncodedBytes(fitting + 1, fitting + 2, static_cast<size_t>(sensors),
                                                  mask_size) <= kMaximumEncodedBytes) {
    ++fitting;
  }
  return static_cast<int>(fitting);
}
static_assert(FittingTransitions(kMaximumSensors) >= 1);
static_assert(FittingTransitions(1) <= kMaximumTransitionsPerMessage);
static_assert(kMaximumSensors == transitions_t::MAXIMUM_SENSOR_COUNT);
static_assert(kMaximumSensors == flight_t::MAXIMUM_SENSOR_COUNT);

void AddState(const State& state, transitions_t& message) {
  message.column.push_back(static_cast<int16_t>(state.cell.column));
  message.row.push_back(static_cast<int16_t>(state.cell.row));
  message.time_margin.push_back(static_cast<int16_t>(state.time_margin));
  message.energy_margin_j.push_back(state.energy_margin_j);
  message.aoi.push_back(state.aoi);
}

void AddTransition(const OrderResult& result, int transition, transitions_t& message) {
  const size_t i = static_cast<size_t>(transition);
  const auto mask = result.episode.next_masks.begin() + transition * message.mask_size;
  message.action.push_back(result.episode.actions[i]);
  message.reward.push_back(result.episode.rewards[i]);
  message.td_error.push_back(result.td_errors[i]);
  message.next_mask.emplace_back(mask, mask + message.mask_size);
}

transitions_t MessageOf(const World& world, const OrderResult& result, int first, int count) {
  const Episode& episode = result.episode;
  transitions_t message{};
  message.transition_count = count;
  message.state_count = count + 1;
  message.sensor_count = world.sensors();
  message.mask_size = MaskSize(world);
  message.order_index = result.order_index;
  message.first_transition = first;
  message.outcome =
      static_cast<int8_t>(first + count == episode.transitions() ? episode.outcome : Outcome::kFlying);
  for (int i = first; i <= first + count; ++i) {
    AddState(episode.states[static_cast<size_t>(i)], message);
  }
  for (int i = first; i < first + count; ++i) {
    AddTransition(result, i, message);
  }
  return message;
}

bool SizesMatch(const World& world, const transitions_t& message) {
  return message.transition_count >= 1 && message.state_count == message.transition_count + 1 &&
         message.sensor_count == world.sensors() && message.mask_size == MaskSize(world) &&
         message.first_transition >= 0 &&
         message.first_transition + message.transition_count <= world.maximum_transitions() &&
         message.order_index >= 0 && message.outcome >= 0 && message.outcome <= 3;
}

bool ReadState(const World& world, const transitions_t& message, size_t i, State& state) {
  state.slot = message.first_transition + static_cast<int>(i) + 1;
  state.cell = {message.column[i], message.row[i]};
  state.time_margin = message.time_margin[i];
  state.energy_margin_j = message.energy_margin_j[i];
  state.aoi = message.aoi[i];
  return world.OnGrid(state.cell) && std::isfinite(state.energy_margin_j) &&
         std::all_of(state.aoi.begin(), state.aoi.end(),
                     [&](int16_t aoi) { return aoi >= 1 && aoi <= world.scenario().slots; });
}

bool ReadTransition(const World& world, const transitions_t& message, size_t i, OrderResult& result) {
  result.episode.actions.push_back(message.action[i]);
  result.episode.rewards.push_back(message.reward[i]);
  result.td_errors.push_back(message.td_error[i]);
  for (const auto byte : message.next_mask[i]) {
    result.episode.next_masks.push_back(static_cast<uint8_t>(byte));
  }
  return message.action[i] >= 0 && message.action[i] < world.actions() && std::isfinite(message.reward[i]) &&
         std::isfinite(message.td_error[i]);
}

}  // namespace

order_t ToWire(const Order& order, int64_t actor_id, int32_t attempt) {
  order_t message{};
  message.index = order.index;
  message.actor_id = actor_id;
  message.attempt = attempt;
  message.kind = static_cast<int8_t>(order.kind);
  message.epsilon = order.epsilon;
  message.seed = static_cast<int64_t>(order.seed);
  message.current_version = order.current_version;
  message.target_version = order.target_version;
  return message;
}

bool FromWire(const order_t& message, Order& order) {
  order = {message.index,           static_cast<OrderKind>(message.kind),
           message.epsilon,         static_cast<uint64_t>(message.seed),
           message.current_version, message.target_version};
  return message.index >= 0 && message.index < (int64_t{1} << 32) &&
         (message.kind == 0 || message.kind == 1) && message.epsilon >= 0 && message.epsilon <= 1 &&
         message.current_version >= 0 && message.target_version >= 0 && message.attempt >= 0;
}

int TransitionsPerMessage(int sensors) {
  FRESCO_CHECK(sensors >= 1 && sensors <= kMaximumSensors);
  return FittingTransitions(sensors);
}

void SplitResult(const World& world, const OrderResult& result, int64_t actor_id,
                 const std::function<void(const transitions_t&)>& send) {
  const int step = TransitionsPerMessage(world.sensors());
  const int transitions = result.episode.transitions();
  for (int first = 0; first < transitions; first += step) {
    transitions_t message = MessageOf(world, result, first, std::min(step, transitions - first));
    message.actor_id = actor_id;
    send(message);
  }
}

bool FromWire(const World& world, const transitions_t& message, OrderResult& result) {
  result.episode.Clear();
  result.td_errors.clear();
  if (!SizesMatch(world, message)) {
    return false;
  }
  result.order_index = message.order_index;
  result.first_transition = message.first_transition;
  result.episode.outcome = static_cast<Outcome>(message.outcome);
  bool valid = true;
  for (size_t i = 0; valid && i < static_cast<size_t>(message.state_count); ++i) {
    valid = ReadState(world, message, i, result.episode.states.emplace_back());
  }
  for (size_t i = 0; valid && i < static_cast<size_t>(message.transition_count); ++i) {
    valid = ReadTransition(world, message, i, result);
  }
  return valid;
}

int64_t LongestResultBytes(const World& world) {
  const auto td_errors = world.maximum_transitions() * static_cast<int64_t>(sizeof(float));
  return LongestEpisodeBytes(world) + static_cast<int64_t>(sizeof(OrderResult) - sizeof(Episode)) + td_errors;
}

}  // namespace fresco
