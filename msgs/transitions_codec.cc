#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/memory.h"
#include "msgs/episode.h"

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

void AddTransition(const Episode& episode, int transition, transitions_t& message) {
  const size_t i = static_cast<size_t>(transition);
  const auto mask = episode.next_masks.begin() + transition * message.mask_size;
  message.action.push_back(episode.actions[i]);
  message.reward.push_back(episode.rewards[i]);
  message.td_error.push_back(episode.td_errors[i]);
  message.next_mask.emplace_back(mask, mask + message.mask_size);
}

transitions_t MessageOf(const World& world, const Episode& episode, int first, int count) {
  transitions_t message{};
  message.transition_count = count;
  message.state_count = count + 1;
  message.sensor_count = world.sensors();
  message.mask_size = MaskSize(world);
  message.order_index = episode.order_index;
  message.first_transition = first;
  message.outcome =
      static_cast<int8_t>(first + count == episode.transitions() ? episode.outcome : Outcome::kFlying);
  for (int i = first; i <= first + count; ++i) {
    AddState(episode.states[static_cast<size_t>(i)], message);
  }
  for (int i = first; i < first + count; ++i) {
    AddTransition(episode, i, message);
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

bool ReadTransition(const World& world, const transitions_t& message, size_t i, Episode& run) {
  run.actions.push_back(message.action[i]);
  run.rewards.push_back(message.reward[i]);
  run.td_errors.push_back(message.td_error[i]);
  for (const auto byte : message.next_mask[i]) {
    run.next_masks.push_back(static_cast<uint8_t>(byte));
  }
  return message.action[i] >= 0 && message.action[i] < world.actions() && std::isfinite(message.reward[i]) &&
         std::isfinite(message.td_error[i]);
}

}  // namespace

int64_t LongestEpisodeBytes(const World& world) {
  const auto values = [](const auto& vector) { return static_cast<int64_t>(sizeof(vector[0])); };
  const Episode episode;
  const State state;
  const int64_t transitions = world.maximum_transitions();
  const int64_t state_bytes = values(episode.states) + HeapBytes(world.sensors() * values(state.aoi));
  const int64_t transition_bytes = values(episode.actions) + values(episode.rewards) +
                                   values(episode.td_errors) + MaskSize(world) * values(episode.next_masks);
  return static_cast<int64_t>(sizeof(Episode)) + (transitions + 1) * state_bytes +
         transitions * transition_bytes;
}

void Episode::Clear() {
  order_index = 0;
  first_transition = 0;
  outcome = Outcome::kFlying;
  states.clear();
  actions.clear();
  rewards.clear();
  td_errors.clear();
  next_masks.clear();
}

void AppendMask(std::span<const uint8_t> mask, std::vector<uint8_t>& packed) {
  const size_t begin = packed.size();
  packed.resize(begin + (mask.size() + 7) / 8, 0);
  for (size_t action = 0; action < mask.size(); ++action) {
    if (mask[action] != 0) {
      packed[begin + action / 8] = static_cast<uint8_t>(packed[begin + action / 8] | (1u << (action % 8)));
    }
  }
}

int TransitionsPerMessage(int sensors) {
  FRESCO_CHECK(sensors >= 1 && sensors <= kMaximumSensors);
  return FittingTransitions(sensors);
}

void SplitEpisode(const World& world, const Episode& episode, int64_t actor_id,
                  const std::function<void(const transitions_t&)>& send) {
  const int step = TransitionsPerMessage(world.sensors());
  for (int first = 0; first < episode.transitions(); first += step) {
    transitions_t message = MessageOf(world, episode, first, std::min(step, episode.transitions() - first));
    message.actor_id = actor_id;
    send(message);
  }
}

bool ToEpisodeRun(const World& world, const transitions_t& message, Episode& run) {
  run.Clear();
  if (!SizesMatch(world, message)) {
    return false;
  }
  run.order_index = message.order_index;
  run.first_transition = message.first_transition;
  run.outcome = static_cast<Outcome>(message.outcome);
  bool valid = true;
  for (size_t i = 0; valid && i < static_cast<size_t>(message.state_count); ++i) {
    valid = ReadState(world, message, i, run.states.emplace_back());
  }
  for (size_t i = 0; valid && i < static_cast<size_t>(message.transition_count); ++i) {
    valid = ReadTransition(world, message, i, run);
  }
  return valid;
}

}  // namespace fresco
