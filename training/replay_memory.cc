#include "training/replay_memory.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace fresco {

MiniBatch::MiniBatch(int inputs, int action_count, int batch_size)
    : observations(inputs, batch_size),
      next_observations(inputs, batch_size),
      actions(static_cast<size_t>(batch_size)),
      rewards(static_cast<size_t>(batch_size)),
      terminal(static_cast<size_t>(batch_size)),
      least_values(static_cast<size_t>(batch_size), -std::numeric_limits<float>::infinity()),
      next_masks(static_cast<size_t>(action_count) * static_cast<size_t>(batch_size)) {}

ReplayMemory::ReplayMemory(int inputs, int actions, int64_t capacity)
    : actions_(actions),
      capacity_(capacity),
      observations_(inputs, capacity),
      next_observations_(inputs, capacity),
      action_(static_cast<size_t>(capacity)),
      reward_(static_cast<size_t>(capacity)),
      terminal_(static_cast<size_t>(capacity)),
      least_value_(static_cast<size_t>(capacity)),
      mask_size_(MaskBytes(actions)),
      masks_(mask_size_ * static_cast<size_t>(capacity)) {}

int64_t MiniBatch::BytesFor(int inputs, int action_count, int batch_size) {
  const size_t of_transition = 2 * static_cast<size_t>(inputs) * sizeof(Matrix::Scalar) +
                               static_cast<size_t>(action_count) * sizeof(decltype(next_masks)::value_type) +
                               sizeof(decltype(actions)::value_type) + sizeof(decltype(rewards)::value_type) +
                               sizeof(decltype(terminal)::value_type) +
                               sizeof(decltype(least_values)::value_type);
  return batch_size * static_cast<int64_t>(of_transition);
}

int64_t ReplayMemory::BytesFor(int inputs, int actions, int64_t capacity) {
  const size_t of_transition =
      2 * static_cast<size_t>(inputs) * sizeof(Matrix::Scalar) + sizeof(decltype(action_)::value_type) +
      sizeof(decltype(reward_)::value_type) + sizeof(decltype(terminal_)::value_type) +
      sizeof(decltype(least_value_)::value_type) + MaskBytes(actions) * sizeof(decltype(masks_)::value_type);
  return capacity * static_cast<int64_t>(of_transition);
}

void ReplayMemory::Insert(const Transition& transition) {
  FRESCO_CHECK(static_cast<int64_t>(transition.observation.size()) == observations_.rows());
  FRESCO_CHECK(transition.next_mask.size() == mask_size_);
  const auto index = static_cast<size_t>(next_);
  std::copy(transition.observation.begin(), transition.observation.end(), observations_.col(next_).data());
  std::copy(transition.next_observation.begin(), transition.next_observation.end(),
            next_observations_.col(next_).data());
  action_[index] = transition.action;
  reward_[index] = transition.reward;
  terminal_[index] = transition.terminal ? 1 : 0;
  least_value_[index] = transition.least_value;
  std::copy(transition.next_mask.begin(), transition.next_mask.end(), masks_.data() + index * mask_size_);
  next_ = (next_ + 1) % capacity_;
  size_ = std::min(size_ + 1, capacity_);
}

void ReplayMemory::Sample(RandomStream& stream, MiniBatch& batch) const {
  FRESCO_CHECK(size_ >= 1);
  for (int column = 0; column < batch.size(); ++column) {
    Copy(stream.NextBelow(static_cast<uint32_t>(size_)), column, batch);
  }
}

void ReplayMemory::Copy(int64_t index, int column, MiniBatch& batch) const {
  const auto from = static_cast<size_t>(index);
  const auto to = static_cast<size_t>(column);
  batch.observations.col(column) = observations_.col(index);
  batch.next_observations.col(column) = next_observations_.col(index);
  batch.actions[to] = action_[from];
  batch.rewards[to] = reward_[from];
  batch.terminal[to] = terminal_[from];
  batch.least_values[to] = least_value_[from];
  const uint8_t* mask = masks_.data() + from * mask_size_;
  for (int action = 0; action < actions_; ++action) {
    const bool allowed = (mask[action / 8] >> (action % 8) & 1) != 0;
    batch.next_masks[to * static_cast<size_t>(actions_) + static_cast<size_t>(action)] = allowed ? 1 : 0;
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
