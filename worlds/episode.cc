#include "worlds/episode.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"

namespace fresco {

void Episode::Clear() {
  ending = Ending::kNone;
  states.clear();
  actions.clear();
  rewards.clear();
  next_masks.clear();
}

void Episode::ShrinkToFit() {
  states.shrink_to_fit();
  actions.shrink_to_fit();
  rewards.shrink_to_fit();
  next_masks.shrink_to_fit();
}

void AppendMask(std::span<const uint8_t> mask, std::vector<uint8_t>& packed) {
  constexpr size_t kBits = 8;
  for (size_t first = 0; first < mask.size(); first += kBits) {
    const size_t end = std::min(first + kBits, mask.size());
    unsigned bits = 0;
    for (size_t action = first; action < end; ++action) {
      bits |= unsigned{mask[action]} << (action - first);
    }
    packed.push_back(static_cast<uint8_t>(bits));
  }
}

bool IsAllowedNext(const Episode& episode, size_t i, int action, int actions) {
  const auto byte = i * static_cast<size_t>(MaskSize(actions)) + static_cast<size_t>(action / 8);
  return (episode.next_masks[byte] >> (action % 8) & 1) != 0;
}

double Return(const Episode& episode) {
  double sum = 0;
  for (const float reward : episode.rewards) {
    sum += reward;
  }
  return sum;
}

double GapPercent(double score, double least_score) {
  constexpr double kRounding = 1e-9;  // of sums of the same ages in another order
  const double gap = 100 * (score - least_score) / least_score;
  return std::abs(gap) < kRounding ? 0 : gap;
}

int RandomAllowedAction(std::span<const uint8_t> mask, RandomStream& stream) {
  const auto allowed = static_cast<uint32_t>(std::count(mask.begin(), mask.end(), 1));
  FRESCO_CHECK(allowed > 0);
  uint32_t number = stream.NextBelow(allowed);
  size_t action = 0;
  while (mask[action] != 1 || number-- != 0) {
    ++action;
  }
  return static_cast<int>(action);
}

int64_t LongestEpisodeBytes(const World& world) {
  const int64_t transitions = world.longest_episode();
  const auto state_bytes = world.state_size() * static_cast<int64_t>(sizeof(float));
  const auto transition_bytes =
      static_cast<int64_t>(sizeof(int16_t) + sizeof(float)) + MaskSize(world.actions());
  return static_cast<int64_t>(sizeof(Episode)) + (transitions + 1) * state_bytes +
         transitions * transition_bytes;
}

bool SameBits(const Episode& a, const Episode& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return a.ending == b.ending && same(a.states, b.states) && same(a.actions, b.actions) &&
         same(a.rewards, b.rewards) && same(a.next_masks, b.next_masks);
}

EpisodeRecorder::EpisodeRecorder(const World& world)
    : world_(&world), environment_(world.NewEnvironment()), mask_(static_cast<size_t>(world.actions())) {}

void EpisodeRecorder::Begin(uint64_t seed) {
  episode_.Clear();
  episode_.seed = seed;
  environment_->Reset(seed);
  AddState();
}

void EpisodeRecorder::AddState() {
  const auto size = static_cast<size_t>(world_->state_size());
  episode_.states.resize(episode_.states.size() + size);
  environment_->WriteState(std::span(episode_.states).last(size));
  environment_->WriteMask(mask_);
  FRESCO_CHECK(std::find(mask_.begin(), mask_.end(), 1) != mask_.end());  // the world forbids every action
}

void EpisodeRecorder::Step(int action) {
  const StepResult result = environment_->Step(action);
  episode_.actions.push_back(static_cast<int16_t>(action));
  episode_.rewards.push_back(static_cast<float>(result.reward));
  AddState();
  AppendMask(mask_, episode_.next_masks);
  episode_.ending = result.ending;
}

bool FlyActions(uint64_t seed, std::span<const int16_t> actions, EpisodeRecorder& recorder) {
  recorder.Begin(seed);
  const std::vector<uint8_t>& mask = recorder.mask();
  for (const int16_t action : actions) {
    if (action < 0 || static_cast<size_t>(action) >= mask.size() || mask[static_cast<size_t>(action)] == 0) {
      return false;
    }
    recorder.Step(action);
    if (recorder.ended()) {
      return true;
    }
  }
  return false;
}

bool FlyActions(const World& world, uint64_t seed, std::span<const int16_t> actions, Episode& episode) {
  EpisodeRecorder recorder(world);
  if (!FlyActions(seed, actions, recorder)) {
    return false;
  }
  episode = recorder.Release();
  return true;
}

}  // namespace fresco
