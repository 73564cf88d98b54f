#include "tests/bench/environment_batch.h"

#include <algorithm>

#include "core/error.h"

namespace fresco {

EnvironmentBatch::EnvironmentBatch(const Experiment& experiment, int count)
    : experiment_(experiment),
      observation_size_(static_cast<size_t>(experiment.world().observation_size())),
      actions_(static_cast<size_t>(experiment.world().actions())),
      observations_(static_cast<size_t>(count) * observation_size_),
      masks_(static_cast<size_t>(count) * actions_, 1),
      rewards_(static_cast<size_t>(count)),
      endings_(static_cast<size_t>(count)),
      flies_(static_cast<size_t>(count)) {
  FRESCO_CHECK(count >= 1);
  for (int i = 0; i < count; ++i) {
    recorders_.emplace_back(experiment_.world(), 0);
  }
}

void EnvironmentBatch::Reset(std::span<const uint64_t> seeds) {
  FRESCO_CHECK(seeds.size() <= recorders_.size());
  std::fill(flies_.begin(), flies_.end(), 0);
  std::fill(rewards_.begin(), rewards_.end(), 0.0F);
  for (size_t i = 0; i < seeds.size(); ++i) {
    recorders_[i].Begin(seeds[i]);
    flies_[i] = 1;
    WriteRow(i);
  }
}

int EnvironmentBatch::Step(std::span<const int64_t> actions) {
  FRESCO_CHECK(actions.size() == recorders_.size());
  int flying = 0;
  for (size_t i = 0; i < recorders_.size(); ++i) {
    rewards_[i] = 0;
    if (flies_[i] == 0) {
      continue;
    }
    FRESCO_CHECK(actions[i] >= 0 && actions[i] < static_cast<int64_t>(actions_));
    recorders_[i].Step(static_cast<int>(actions[i]));
    rewards_[i] = recorders_[i].episode().rewards.back();
    flies_[i] = recorders_[i].ended() ? 0 : 1;
    flying += flies_[i];
    WriteRow(i);
  }
  return flying;
}

void EnvironmentBatch::WriteRow(size_t environment) {
  const EpisodeRecorder& recorder = recorders_[environment];
  world().Observe(recorder.state(),
                  std::span(observations_).subspan(environment * observation_size_, observation_size_));
  std::copy(recorder.mask().begin(), recorder.mask().end(),
            masks_.begin() + static_cast<int64_t>(environment * actions_));
  endings_[environment] = static_cast<uint8_t>(recorder.episode().ending);
}

void EnvironmentBatch::AreAt(std::span<const int32_t> places, std::span<uint8_t> at) const {
  FRESCO_CHECK(places.size() == recorders_.size() && at.size() == recorders_.size());
  for (size_t i = 0; i < recorders_.size(); ++i) {
    at[i] = places[i] >= 0 && world().IsAt(recorders_[i].state(), places[i]) ? 1 : 0;
  }
}

void EnvironmentBatch::MasksTowards(std::span<const int32_t> places, std::span<uint8_t> masks) const {
  FRESCO_CHECK(places.size() == recorders_.size() && masks.size() == masks_.size());
  for (size_t i = 0; i < recorders_.size(); ++i) {
    const int all = world().actions();
    const ActionRange range =
        places[i] >= 0 ? world().Towards(recorders_[i].state(), places[i]) : ActionRange{0, all};
    for (int action = 0; action < all; ++action) {
      const size_t entry = i * actions_ + static_cast<size_t>(action);
      masks[entry] = action >= range.first && action < range.end ? masks_[entry] : 0;
    }
  }
}

}  // namespace fresco
