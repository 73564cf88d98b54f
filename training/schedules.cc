#include "training/schedules.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace fresco {
namespace {

/// base^exponent by squaring. Unlike std::pow, it gives the same bits with every mathematical library.
double IntegerPower(double base, int64_t exponent) {
  double power = 1;
  for (; exponent > 0; exponent /= 2, base *= base) {
    if (exponent % 2 == 1) {
      power *= base;
    }
  }
  return power;
}

/// The stream of an episode.
RandomStream StreamOf(uint64_t seed, RandomPurpose purpose, int64_t episode) {
  const auto number = static_cast<uint64_t>(episode);
  return {seed, purpose, static_cast<uint32_t>(number), static_cast<uint32_t>(number >> 32)};
}

uint64_t SeedOf(uint64_t seed, RandomPurpose purpose, int64_t number) {
  RandomStream stream = StreamOf(seed, purpose, number);
  const uint64_t high = stream.NextWord();
  return high << 32 | stream.NextWord();
}

/// Of schedule.evaluation_episodes evaluation episodes.
std::vector<uint64_t> EvaluationSeeds(const proto::Schedule& schedule, int64_t first) {
  std::vector<uint64_t> seeds;
  for (int i = 0; i < schedule.evaluation_episodes(); ++i) {
    seeds.push_back(EvaluationSeed(schedule.seed(), first + i));
  }
  return seeds;
}

}  // namespace

uint64_t EpisodeSeed(uint64_t seed, int64_t episode) {
  return SeedOf(seed, RandomPurpose::kEpisodeSeed, episode);
}

uint64_t EvaluationSeed(uint64_t seed, int64_t episode) {
  return SeedOf(seed, RandomPurpose::kEvaluationSeed, episode);
}

std::vector<uint64_t> FixedEvaluationSeeds(const proto::Schedule& schedule) {
  return EvaluationSeeds(schedule, 0);
}

std::vector<uint64_t> FixedDeliverySeeds(const proto::Schedule& schedule) {
  return EvaluationSeeds(schedule, schedule.evaluation_episodes());
}

std::optional<int> SearchedFrom(const proto::Schedule& schedule, int64_t episode, int longest_episode) {
  RandomStream stream = StreamOf(schedule.seed(), RandomPurpose::kSearchOrders, episode);
  if (!schedule.has_search() || stream.NextUniform() >= schedule.search().share()) {
    return std::nullopt;
  }
  const double first = stream.NextUniform();
  return static_cast<int>(first * stream.NextUniform() * longest_episode);
}

double EpsilonOf(const proto::Schedule& schedule, int64_t episode, int64_t transitions) {
  if (schedule.has_ladder()) {
    const proto::LadderEpsilon& ladder = schedule.ladder();
    const auto rung = static_cast<double>(episode % ladder.rungs());
    // Rounded to single precision, since mathematical libraries differ in the last bits of double precision.
    return static_cast<float>(std::pow(ladder.base(), 1 + ladder.exponent() * rung / (ladder.rungs() - 1)));
  }
  const proto::LinearEpsilon& linear = schedule.linear();
  return std::max(linear.minimum(), linear.initial() - linear.decrement() * static_cast<double>(transitions));
}

double LearningRateOf(const proto::Agent& agent, int64_t updates, int64_t episodes,
                      int64_t expected_updates) {
  if (agent.has_linear()) {
    const double progress =
        std::min(1.0, static_cast<double>(updates) / static_cast<double>(expected_updates));
    return agent.linear().initial() + (agent.linear().final() - agent.linear().initial()) * progress;
  }
  const proto::ExponentialDecay& decay = agent.exponential();
  const int64_t steps = decay.unit() == proto::ExponentialDecay::EPISODES ? episodes : updates;
  return decay.initial() * IntegerPower(decay.decay_rate(), steps / decay.decay_steps());
}

int64_t ExpectedUpdates(const proto::Schedule& schedule, int transitions_per_episode) {
  return std::max<int64_t>(1, schedule.episodes() * transitions_per_episode / schedule.inserts_per_update());
}

}  // namespace fresco
