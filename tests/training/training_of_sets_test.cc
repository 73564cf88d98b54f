// A training with a network for sets, in one loop.
#include <gtest/gtest.h>

#include "planner/planner.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

TEST(TrainingOfSets, ReachesTheOptimumOfASmallField) {
  const Experiment experiment = SmallSetExperiment(
      {{"schedule.episodes", "800"}, {"schedule.excursion_share", "0.3"}, {"agent.replay_capacity", "5000"}});
  const Plan plan = PlanOptimally(experiment.world(), 0);
  ASSERT_TRUE(plan.optimal);
  std::vector<double> figures(3);
  experiment.world().Judge(plan.flight, figures);
  EXPECT_EQ(RunInOneLoop(experiment).best_score, figures.front());
}

TEST(TrainingOfSets, IsTheSameEveryTime) {
  EXPECT_EQ(RunInOneLoop(SmallSetExperiment()).weights, RunInOneLoop(SmallSetExperiment()).weights);
}

}  // namespace
}  // namespace fresco
