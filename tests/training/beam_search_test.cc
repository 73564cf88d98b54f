// The beam search against a search of every episode, and against a greedy flight.
#include "training/beam_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "planner/planner.h"
#include "tests/training/literal_run.h"
#include "training/flyer.h"
#include "worlds/cartpole/cartpole.h"

namespace fresco {
namespace {

Experiment TinyField(const std::string& scenario = "") {
  return Experiment::Parse(
      "scenario { grid { columns: 4 rows: 4 } slots: 7 start { column: 0 row: 0 } stop { column: 2 row: 1 } "
      "sensor { x_m: 10 y_m: 80 } sensor { x_m: 70 y_m: 5 weight: 2 } coverage_radius_m: 26 " +
          scenario + "} agent { hidden_layers: [16] safe_action_mask: true coverage_mask: true }",
      "test");
}

std::shared_ptr<const Vector> Parameters(const Experiment& experiment) {
  return std::make_shared<const Vector>(experiment.network()->InitialParameters(3));
}

std::vector<int16_t> Search(const Experiment& experiment, uint64_t seed, int width) {
  BeamSearch search(experiment, width);
  search.Begin(seed, Parameters(experiment));
  while (search.Step()) {
  }
  return search.BestActions();
}

double ReturnOf(const Experiment& experiment, uint64_t seed, const std::vector<int16_t>& actions) {
  Episode episode;
  EXPECT_TRUE(FlyActions(experiment.world(), seed, actions, episode));
  EXPECT_EQ(actions.size(), episode.actions.size());
  return Return(episode);
}

/// The best return of all episodes, by trying every allowed action in every state.
double BestReturn(const Experiment& experiment, std::vector<int16_t>& actions) {
  EpisodeRecorder recorder(experiment.world(), 0);
  for (const int16_t action : actions) {
    recorder.Step(action);
  }
  if (recorder.ended()) {
    return Return(recorder.episode());
  }
  double best = -1e9;
  const std::vector<uint8_t> mask = recorder.mask();
  for (size_t action = 0; action < mask.size(); ++action) {
    if (mask[action] != 0) {
      actions.push_back(static_cast<int16_t>(action));
      best = std::max(best, BestReturn(experiment, actions));
      actions.pop_back();
    }
  }
  return best;
}

TEST(BeamSearch, FindsTheBestEpisodeIfItIsWideEnoughForAll) {
  const Experiment experiment = TinyField();
  std::vector<int16_t> actions;
  EXPECT_NEAR(ReturnOf(experiment, 0, Search(experiment, 0, 3000)), BestReturn(experiment, actions), 1e-6);
}

TEST(BeamSearch, FindsTheOptimumOfAField) {
  const Experiment experiment = TinyField("maximum_aoi: 5");
  const Plan plan = PlanOptimally(experiment.world(), 0);
  ASSERT_TRUE(plan.optimal);
  EXPECT_NEAR(ReturnOf(experiment, 0, Search(experiment, 0, 3000)), Return(plan.flight), 1e-6);
}

TEST(BeamSearch, IsTheGreedyFlightIfItIsOneWide) {
  const Experiment experiment = SmallExperiment();
  const Episode greedy = FlyGreedily(experiment, 0, Parameters(experiment));
  EXPECT_EQ(Search(experiment, 0, 1), greedy.actions);
}

TEST(BeamSearch, WorksInWorldsWhoseEpisodesBeginAtRandom) {
  const Experiment experiment = Experiment::Parse("cartpole { maximum_steps: 60 }", "test");
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    // With an untrained network: it has 60 steps, since some partial episode is still balanced.
    EXPECT_EQ(ReturnOf(experiment, seed, Search(experiment, seed, 64)), 60);
  }
}

TEST(BeamSearch, IsAFunctionOfSeedAndWidthOnly) {
  const Experiment experiment = Experiment::Parse(
      "scenario { random_sensors { per_episode: true minimum: 1 maximum: 4 } slots: 30 } "
      "agent { set_network { encoder_layers: [8] trunk_layers: [8] head_layers: [8] } safe_action_mask: true "
      "}",
      "test");
  BeamSearch search(experiment, 6);
  std::vector<std::vector<int16_t>> first;
  for (int round = 0; round < 2; ++round) {
    for (uint64_t seed = 0; seed < 5; ++seed) {
      search.Begin(seed, Parameters(experiment));
      while (search.Step()) {
      }
      if (round == 0) {
        first.push_back(search.BestActions());
      }
      EXPECT_EQ(search.BestActions(), first[seed]);
      EXPECT_EQ(Search(experiment, seed, 6), first[seed]);
      ReturnOf(experiment, seed, first[seed]);
    }
  }
}

TEST(BeamSearch, GoesOnBehindTheFirstActions) {
  const Experiment experiment = TinyField();
  const Episode flown = FlyGreedily(experiment, 0, Parameters(experiment));
  for (size_t first = 0; first < flown.actions.size(); ++first) {
    std::vector<int16_t> actions(flown.actions.begin(), flown.actions.begin() + static_cast<int64_t>(first));
    BeamSearch search(experiment, 3000);
    search.Begin(0, Parameters(experiment), actions);
    while (search.Step()) {
    }
    const std::vector<int16_t> found = search.BestActions();
    EXPECT_TRUE(std::equal(actions.begin(), actions.end(), found.begin()));
    EXPECT_NEAR(ReturnOf(experiment, 0, found), BestReturn(experiment, actions), 1e-6) << first;
  }
}

TEST(FlySearching, IsNeverWorseThanTheGreedyFlight) {
  const Experiment experiment = SmallExperiment();
  const auto parameters = Parameters(experiment);
  const double greedy = Return(FlyGreedily(experiment, 0, parameters));
  for (const int width : {1, 2, 5, 50}) {
    EXPECT_GE(Return(FlySearching(experiment, 0, parameters, width)), greedy);
  }
}

}  // namespace
}  // namespace fresco
