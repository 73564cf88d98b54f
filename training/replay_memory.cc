#include "training/replay_memory.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace fresco {
namespace {

/// The floats whose memory so many bytes take.
constexpr size_t FloatsFor(size_t bytes) {
  return (bytes + sizeof(float) - 1) / sizeof(float);
}

}  // namespace

MiniBatch::MiniBatch(int inputs, int action_count, int batch_size)
    : observations(inputs, batch_size),
      next_observations(inputs, batch_size),
      actions(static_cast<size_t>(batch_size)),
      rewards(static_cast<size_t>(batch_size)),
      discounts(static_cast<size_t>(batch_size)),
      least_values(static_cast<size_t>(batch_size), -std::numeric_limits<float>::infinity()),
      next_masks(static_cast<size_t>(action_count) * static_cast<size_t>(batch_size)) {}

ReplayMemory::ReplayMemory(int inputs, int actions, int64_t capacity)
    : inputs_(static_cast<size_t>(inputs)),
      actions_(actions),
      mask_size_((static_cast<size_t>(actions) + 7) / 8),
      record_size_(2 * inputs_ + FloatsFor(sizeof(Rest)) + FloatsFor(mask_size_)),
      capacity_(capacity),
      records_(record_size_ * static_cast<size_t>(capacity)) {}

int64_t MiniBatch::BytesFor(int inputs, int action_count, int batch_size) {
  const size_t of_transition = 2 * static_cast<size_t>(inputs) * sizeof(Matrix::Scalar) +
                               static_cast<size_t>(action_count) * sizeof(decltype(next_masks)::value_type) +
                               sizeof(decltype(actions)::value_type) + sizeof(decltype(rewards)::value_type) +
                               sizeof(decltype(discounts)::value_type) +
                               sizeof(decltype(least_values)::value_type);
  return batch_size * static_cast<int64_t>(of_transition);
}

int64_t ReplayMemory::BytesFor(int inputs, int actions, int64_t capacity) {
  const ReplayMemory one(inputs, actions, 1);
  return capacity * static_cast<int64_t>(one.record_size_ * sizeof(float));
}

void ReplayMemory::Insert(const Transition& transition) {
  FRESCO_CHECK(transition.observation.size() == inputs_ && transition.next_observation.size() == inputs_);
  FRESCO_CHECK(transition.next_mask.size() == mask_size_);
  float* record = Record(next_);
  record = std::copy(transition.observation.begin(), transition.observation.end(), record);
  record = std::copy(transition.next_observation.begin(), transition.next_observation.end(), record);
  const Rest rest{transition.reward, transition.discount, transition.least_value, transition.action};
  std::memcpy(record, &rest, sizeof(rest));
  std::memcpy(record + FloatsFor(sizeof(rest)), transition.next_mask.data(), mask_size_);
  next_ = (next_ + 1) % capacity_;
  size_ = std::min(size_ + 1, capacity_);
}

void ReplayMemory::Sample(RandomStream& stream, MiniBatch& batch) const {
  FRESCO_CHECK(size_ >= 1);
  // Most of the transitions are in no cache. Asked for ahead of time, they come side by side.
  constexpr int kAhead = 16;
  std::array<int64_t, kAhead> coming;
  for (int column = 0; column < batch.size() + kAhead; ++column) {
    int64_t& index = coming[static_cast<size_t>(column % kAhead)];
    if (column >= kAhead) {
      Copy(index, column - kAhead, batch);
    }
    if (column < batch.size()) {
      index = stream.NextBelow(static_cast<uint32_t>(size_));
      Prefetch(index);
    }
  }
}

void ReplayMemory::Prefetch(int64_t index) const {
  constexpr size_t kLine = 64 / sizeof(float);
  const float* record = Record(index);
  for (size_t i = 0; i < record_size_; i += kLine) {
    __builtin_prefetch(record + i);
  }
  __builtin_prefetch(record + record_size_ - 1);
}

void ReplayMemory::Copy(int64_t index, int column, MiniBatch& batch) const {
  const float* record = Record(index);
  std::copy_n(record, inputs_, batch.observations.col(column).data());
  std::copy_n(record + inputs_, inputs_, batch.next_observations.col(column).data());
  record += 2 * inputs_;
  Rest rest;
  std::memcpy(&rest, record, sizeof(rest));
  const auto to = static_cast<size_t>(column);
  batch.actions[to] = rest.action;
  batch.rewards[to] = rest.reward;
  batch.discounts[to] = rest.discount;
  batch.least_values[to] = rest.least_value;
  const auto* mask = reinterpret_cast<const uint8_t*>(record + FloatsFor(sizeof(rest)));
  uint8_t* allowed = batch.next_masks.data() + to * static_cast<size_t>(actions_);
  for (int action = 0; action < actions_; ++action) {
    allowed[action] = mask[action / 8] >> (action % 8) & 1;
  }
}

int64_t EpisodeHistory::BytesFor(const World& world, int64_t capacity) {
  const int64_t longest = LongestEpisodeBytes(world);
  const int64_t of_transition = longest / world.longest_episode() + 1;
  return capacity * of_transition + longest;
}

void EpisodeHistory::Add(std::shared_ptr<const Episode> episode) {
  transitions_ += episode->transitions();
  episodes_.push_back(std::move(episode));
  while (transitions_ - episodes_.front()->transitions() >= capacity_) {
    transitions_ -= episodes_.front()->transitions();
    episodes_.pop_front();
  }
}

}  // namespace fresco
