#include "storage/trained_policy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"
#include "training/flyer.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

/// The training's own flyer says what the policy has to do.
void ExpectActsAsTrained(const std::string& experiment_text) {
  const TemporaryFolder run;
  const Experiment experiment = Experiment::Parse(experiment_text, "a test");
  const Vector parameters = experiment.network()->InitialParameters(3);
  WriteFileAtomically(run.path() / "best.network", SerializeNetworkFile({experiment, 4, 400, parameters}));
  TrainedPolicy policy(run.path().string());
  EpisodeRecorder recorder(policy.world(), 5);
  while (!recorder.ended()) {
    recorder.Step(policy.Act(recorder.environment()));
  }
  const Episode expected = FlyGreedily(experiment, 5, std::make_shared<const Vector>(parameters));
  EXPECT_EQ(recorder.episode().actions, expected.actions);
  EXPECT_TRUE(SameBits(recorder.episode(), expected));
}

TEST(TrainedPolicy, ActsInTheUavsWorld) {
  ExpectActsAsTrained("");
}

TEST(TrainedPolicy, ActsInOtherWorlds) {
  ExpectActsAsTrained("cartpole {}");
}

TEST(TrainedPolicy, ActsOnFieldsWithANetworkForSets) {
  ExpectActsAsTrained(
      "scenario { random_sensors { per_episode: true minimum: 1 maximum: 3 } } agent { set_network {} }");
}

TEST(TrainedPolicy, TakesTheGreatestAllowedValue) {
  const TemporaryFolder run;
  const Experiment experiment = Experiment::Parse("cartpole {}", "a test");
  WriteFileAtomically(run.path() / "best.network",
                      SerializeNetworkFile({experiment, 4, 400, experiment.network()->InitialParameters(3)}));
  TrainedPolicy policy(run.path().string());
  const std::vector<float> state = {0.1F, -0.2F, 0.05F, 0.3F};
  const int best = policy.Act(state, std::vector<uint8_t>{1, 1});
  ASSERT_EQ(policy.values().size(), 2U);
  EXPECT_EQ(best, policy.values()[1] > policy.values()[0] ? 1 : 0);
  std::vector<uint8_t> other_only = {1, 1};
  other_only[static_cast<size_t>(best)] = 0;
  EXPECT_EQ(policy.Act(state, other_only), 1 - best);
}

TEST(TrainedPolicy, SaysWhatAPolicyIs) {
  EXPECT_THAT(ErrorOf([] { TrainedPolicy("no/such/run"); }),
              testing::AllOf(testing::HasSubstr("policy: expected the folder of a run"),
                             testing::HasSubstr("no/such/run")));
}

}  // namespace
}  // namespace fresco
