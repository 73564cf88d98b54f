// Seeds against the stream that makes them; epsilon and learning rate against values worked by hand.
#include "training/schedules.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/random.h"

namespace fresco {
namespace {

TEST(Schedules, DrawEveryEpisodesSeedFromAPlaceOfItsOwn) {
  // Philox4x32-10 by its definition: counter (0, second, first, purpose 6), key the run's seed.
  const uint64_t seed = 0x0123456789ABCDEF;
  const auto block = Philox4x32({0, 7, 9, 6}, {0x89ABCDEF, 0x01234567});
  EXPECT_EQ(EpisodeSeed(seed, (int64_t{7} << 32) + 9), uint64_t{block[0]} << 32 | block[1]);
}

TEST(Schedules, DrawTheSeedsOfEvaluationsFromPlacesOfTheirOwn) {
  const uint64_t seed = 0x0123456789ABCDEF;
  const auto block = Philox4x32({0, 7, 9, 8}, {0x89ABCDEF, 0x01234567});  // purpose 8
  EXPECT_EQ(EvaluationSeed(seed, (int64_t{7} << 32) + 9), uint64_t{block[0]} << 32 | block[1]);
}

TEST(Schedules, GiveNoTwoEpisodesTheSameSeed) {
  constexpr int64_t kEpisodes = 10'000;
  std::set<uint64_t> seeds;
  for (int64_t episode = 0; episode < kEpisodes; ++episode) {
    seeds.insert(EpisodeSeed(3, episode));
    seeds.insert(EvaluationSeed(3, episode));
    seeds.insert(EvaluationSeed(4, episode));
  }
  EXPECT_EQ(seeds.size(), 3u * kEpisodes);
}

TEST(Schedules, ClimbTheLadderOfApeX) {
  proto::Schedule schedule;
  schedule.mutable_ladder();  // base 0.4, exponent 7, 8 rungs: 0.4^(1 + 7 i / 7)
  const std::vector<double> rungs = {0.4, 0.16, 0.064, 0.0256, 0.01024, 0.004096, 0.0016384, 0.00065536};
  for (int64_t episode = 0; episode < 40; ++episode) {
    EXPECT_EQ(EpsilonOf(schedule, episode, 1000),
              static_cast<float>(rungs[static_cast<size_t>(episode % 8)]));
  }
}

TEST(Schedules, ClimbALadderOfOtherRungs) {
  proto::Schedule schedule;
  schedule.mutable_ladder()->set_base(0.5);
  schedule.mutable_ladder()->set_exponent(3);
  schedule.mutable_ladder()->set_rungs(3);
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 0, 0), 0.5);
  EXPECT_EQ(EpsilonOf(schedule, 1, 0), 0.1767766952966369f);  // 2^-2.5
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 2, 0), 0.0625);
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 3, 0), 0.5);
}

TEST(Schedules, LowerEpsilonWithEveryTransitionToItsMinimum) {
  proto::Schedule schedule;
  schedule.mutable_linear()->set_minimum(0.05);  // from 0.9 by 0.0001
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 0, 0), 0.9);
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 77, 0), 0.9);  // not with the episode
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 0, 1), 0.8999);
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 0, 4000), 0.5);
  EXPECT_NEAR(EpsilonOf(schedule, 0, 8499), 0.0501, 1e-15);
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 0, 8501), 0.05);
  EXPECT_DOUBLE_EQ(EpsilonOf(schedule, 0, 1'000'000'000'000), 0.05);
}

TEST(Schedules, NeverGiveANegativeEpsilon) {
  proto::Schedule schedule;
  schedule.mutable_linear();  // Table II, whose minimum is 0
  EXPECT_EQ(EpsilonOf(schedule, 0, 9001), 0);
  EXPECT_EQ(EpsilonOf(schedule, 0, 1'380'000), 0);
}

TEST(Schedules, DecayTheLearningRateByAStepEveryTenThousandUpdates) {
  proto::Agent agent;
  agent.mutable_exponential();  // Table II: 0.002 * 0.95^floor(updates / 10000)
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 0, 0, 1), 0.002);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 9'999, 500, 1), 0.002);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 10'000, 500, 1), 0.0019);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 20'000, 500, 1), 0.001805);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 39'999, 500, 1), 0.00171475);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 100'000, 500, 1), 0.0011974738784767578);  // 0.95^10
  EXPECT_LT(LearningRateOf(agent, 1'000'000'000'000, 500, 1), 1e-300);
}

TEST(Schedules, DecayTheLearningRateByEpisodesWhereThatIsTheUnit) {
  proto::Agent agent;
  proto::ExponentialDecay& decay = *agent.mutable_exponential();
  decay.set_unit(proto::ExponentialDecay::EPISODES);
  decay.set_initial(0.5);
  decay.set_decay_rate(0.5);
  decay.set_decay_steps(10);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 100'000, 9, 1), 0.5);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 0, 10, 1), 0.25);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 0, 35, 1), 0.0625);
}

TEST(Schedules, LowerTheLearningRateLinearlyAndStayAtItsEnd) {
  proto::Agent agent;
  agent.mutable_linear();  // 0.001 to 0.00001
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 0, 0, 200), 0.001);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 50, 0, 200), 0.0007525);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 100, 7, 200), 0.000505);
  EXPECT_NEAR(LearningRateOf(agent, 200, 0, 200), 0.00001, 1e-18);
  EXPECT_EQ(LearningRateOf(agent, 5000, 0, 200), LearningRateOf(agent, 200, 0, 200));
}

TEST(Schedules, RaiseALearningRateThatEndsHigher) {
  proto::Agent agent;
  agent.mutable_linear()->set_initial(0.25);
  agent.mutable_linear()->set_final(1);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 1, 0, 4), 0.4375);
  EXPECT_DOUBLE_EQ(LearningRateOf(agent, 9, 0, 4), 1);
}

TEST(Schedules, ExpectAnUpdateEveryFewInsertions) {
  proto::Schedule schedule;  // Table II: 20,000 episodes, an update a transition
  EXPECT_EQ(ExpectedUpdates(schedule, 69), 1'380'000);
  schedule.set_inserts_per_update(4);
  EXPECT_EQ(ExpectedUpdates(schedule, 69), 345'000);
  schedule.set_episodes(1);
  EXPECT_EQ(ExpectedUpdates(schedule, 69), 17);
  schedule.set_inserts_per_update(1'000'000);
  EXPECT_EQ(ExpectedUpdates(schedule, 69), 1);  // never 0: it is divided by
  schedule.set_inserts_per_update(1);
  schedule.set_episodes(4'000'000'000);
  EXPECT_EQ(ExpectedUpdates(schedule, 69), 276'000'000'000);
}

}  // namespace
}  // namespace fresco
