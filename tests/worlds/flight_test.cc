// What is read from an episode of the UAV's world is what its environment said in every slot.
#include "worlds/uav/flight.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

void ExpectSameState(const UavState& found, const UavState& expected) {
  EXPECT_EQ(found.slot, expected.slot);
  EXPECT_EQ(found.cell, expected.cell);
  EXPECT_EQ(found.time_margin, expected.time_margin);
  EXPECT_EQ(found.energy_margin_j, expected.energy_margin_j);
  EXPECT_EQ(found.aoi, expected.aoi);
}

// Repeats the episode in an environment; returns how that ended.
Outcome ExpectFlown(const UavWorld& world, const Episode& episode) {
  UavEnvironment environment(world);
  for (size_t i = 0; i < episode.actions.size(); ++i) {
    ExpectSameState(StateIn(episode, i), environment.state());
    EXPECT_EQ(CellIn(episode.state(i)), environment.state().cell);
    EXPECT_EQ(EnergyIn(world, episode, i), environment.remaining_energy_j());
    EXPECT_EQ(ActionIn(world, episode, i), world.ActionAt(episode.actions[i]));
    environment.Step(world.ActionAt(episode.actions[i]));
  }
  ExpectSameState(StateIn(episode, episode.actions.size()), environment.state());
  EXPECT_EQ(ActionIn(world, episode, episode.actions.size()), Action{});
  EXPECT_EQ(ResidualEnergy(world, episode), environment.remaining_energy_j());
  EXPECT_EQ(OutcomeOf(episode), environment.outcome());
  EXPECT_EQ(Arrived(episode), environment.outcome() == Outcome::kArrived);
  EXPECT_EQ(world.Succeeded(episode), Arrived(episode));
  return environment.outcome();
}

TEST(Flight, IsWhatTheEnvironmentSaysInEverySlot) {
  int outcomes[4] = {};
  for (uint32_t index = 0; index < 500; ++index) {
    SCOPED_TRACE(index);
    const UavWorld world(RandomScenario(index));
    RandomStream stream = TestStream(10, index);
    const Episode episode = Fly(world, [&](const UavEnvironment& environment) {
      return RandomAction(world, environment, {.safe_actions = index % 2 == 0}, &stream);
    });
    const std::vector<UavState> states = StatesIn(episode);
    ASSERT_EQ(states.size(), episode.actions.size() + 1);
    for (size_t i = 0; i < states.size(); ++i) {
      ExpectSameState(states[i], StateIn(episode, i));
    }
    ++outcomes[static_cast<size_t>(ExpectFlown(world, episode))];
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_EQ(outcomes[static_cast<size_t>(Outcome::kFlying)], 0);
  EXPECT_GE(outcomes[static_cast<size_t>(Outcome::kArrived)], 250);
  EXPECT_GT(outcomes[static_cast<size_t>(Outcome::kOutOfTime)], 10);
  EXPECT_GT(outcomes[static_cast<size_t>(Outcome::kOutOfEnergy)], 10);
}

TEST(Flight, IsUnderWayWhereItsEndIsNotRecorded) {
  const UavWorld world(TableOneScenario());
  EpisodeRecorder recorder(world, 0);
  recorder.Step(world.ActionIndex({Move::kNorth, 1}));
  EXPECT_EQ(OutcomeOf(recorder.episode()), Outcome::kFlying);
  EXPECT_FALSE(Arrived(recorder.episode()));
}

TEST(Flight, MayTakeActionsThatTheMaskForbids) {
  const UavWorld world(SquareField(3, 6, {0, 0}, {2, 0}, {{0, 0, 1}}), {.mask = {true, true}});
  const Episode episode = Fly(world, [](const UavEnvironment&) { return Action{Move::kNorth, 1}; });
  EXPECT_EQ(OutcomeOf(episode), Outcome::kOutOfTime);
}

}  // namespace
}  // namespace fresco
