// What every world has from worlds/world.h: its description is checked, and the defaults.
#include "worlds/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "tests/worlds/facts.h"
#include "tests/worlds/test_scenarios.h"
#include "tests/worlds/walk_world.h"

namespace fresco {
namespace {

void MakeWalk(const std::function<void(WorldDescription&)>& change) {
  WorldDescription description = WalkWorld::Description();
  change(description);
  const WalkWorld world(description);
}

TEST(World, HasTheSizesOfItsDescription) {
  const WalkWorld world;
  EXPECT_EQ(world.description().name, "walk");
  EXPECT_EQ(world.state_size(), 2);
  EXPECT_EQ(world.observation_size(), 1);
  EXPECT_EQ(world.actions(), 9);
  EXPECT_EQ(world.longest_episode(), 5);
}

TEST(World, AllowsEveryActionAndHasNoPlacesUnlessItSaysSo) {
  const WalkWorld world;
  std::vector<uint8_t> mask(9);
  world.NewEnvironment()->WriteMask(mask);
  EXPECT_THAT(mask, testing::Each(1));
  EXPECT_FALSE(world.has_places());
}

TEST(Title, IsAQuantityInWords) {
  EXPECT_EQ(Title("average_aoi"), "average AoI");
  EXPECT_EQ(Title("return"), "return");
  EXPECT_EQ(Title("swung_up"), "swung up");
}

TEST(World, TellsAnEpisodeStepByStep) {
  const WalkWorld world;
  Episode episode;
  ASSERT_TRUE(FlyActions(world, 9, std::vector<int16_t>{8, 8}, episode));
  const EpisodeAccount account = world.Tell(episode);
  EXPECT_EQ(account.sentence, "not stayed on the line; last place 25.000");
  EXPECT_THAT(account.facts, testing::ElementsAre(IsFact("stayed_on_the_line", false),
                                                  IsFact("steps", int64_t{2}), IsFact("last_place", 25.0)));
  EXPECT_EQ(account.steps_name, "episode");
  EXPECT_THAT(account.columns, testing::ElementsAre("step", "place", "steps", "action", "reward"));
  using Row = std::vector<AccountValue>;
  EXPECT_THAT(account.steps, testing::ElementsAre(Row{int64_t{0}, 9.0, 0.0, "8", 17.0},
                                                  Row{int64_t{1}, 17.0, 1.0, "8", 25.0},
                                                  Row{int64_t{2}, 25.0, 2.0, {}, {}}));
}

TEST(World, TellsTheUnitOfAFigure) {
  WorldDescription description = WalkWorld::Description();
  description.figures = {{"last_place", "m"}};
  const WalkWorld world(description);
  Episode episode;
  ASSERT_TRUE(FlyActions(world, 2, std::vector<int16_t>(5, 1), episode));
  EXPECT_EQ(world.Tell(episode).sentence, "stayed on the line; last place 7.000 m");
}

TEST(World, TakesADescriptionAtItsLimits) {
  MakeWalk([](WorldDescription& description) {
    description.state.resize(kMaximumStateSize, {"field", ""});
    description.actions.resize(kMaximumActions);
    description.longest_episode = kMaximumEpisode;
    description.discount = 0;
  });
}

TEST(WorldDeathTest, RefusesADescriptionBeyondItsLimits) {
  const auto state = [](int size) {
    MakeWalk([=](WorldDescription& description) {
      description.state.resize(static_cast<size_t>(size), {"field", ""});
    });
  };
  const auto actions = [](int count) {
    MakeWalk([=](WorldDescription& description) { description.actions.resize(static_cast<size_t>(count)); });
  };
  const auto episode = [](int transitions) {
    MakeWalk([=](WorldDescription& description) { description.longest_episode = transitions; });
  };
  const auto discount = [](double value) {
    MakeWalk([=](WorldDescription& description) { description.discount = value; });
  };
  EXPECT_DEATH(state(0), "state_size");
  EXPECT_DEATH(state(kMaximumStateSize + 1), "state_size");
  EXPECT_DEATH(actions(0), "actions");
  EXPECT_DEATH(actions(kMaximumActions + 1), "actions");
  EXPECT_DEATH(episode(0), "longest_episode");
  EXPECT_DEATH(episode(kMaximumEpisode + 1), "longest_episode");
  EXPECT_DEATH(discount(-0.01), "discount");
  EXPECT_DEATH(discount(1.01), "discount");
  EXPECT_DEATH(discount(std::numeric_limits<double>::quiet_NaN()), "discount");
}

TEST(WorldDeathTest, RefusesADescriptionWithoutObservationsOrFigures) {
  const auto observation = [](WorldDescription& description) { description.observation_size = 0; };
  const auto figures = [](WorldDescription& description) { description.figures.clear(); };
  EXPECT_DEATH(MakeWalk(observation), "observation_size");
  EXPECT_DEATH(MakeWalk(figures), "figures");
}

TEST(WorldDeathTest, RefusesSetsThatDoNotFit) {
  const auto sets = [](ObservationSets given) {
    MakeWalk([&](WorldDescription& description) {
      description.observation_size = 2 + 2 * 3;
      description.sets = given;
    });
  };
  sets({2, 2, 3, 3});  // 9 actions
  EXPECT_DEATH(sets({1, 2, 3, 3}), "sets");
  EXPECT_DEATH(sets({2, 3, 2, 3}), "sets");
  EXPECT_DEATH(sets({2, 2, 3, 4}), "sets");
  EXPECT_DEATH(sets({8, 0, 3, 9}), "sets");
}

TEST(WorldDeathTest, RefusesNamesThatAreNone) {
  const std::string too_long(kMaximumNameBytes + 1, 'a');
  for (const std::string& name :
       {std::string(), std::string("Capital"), std::string("two words"), too_long}) {
    EXPECT_DEATH(MakeWalk([&](WorldDescription& description) { description.name = name; }), "name");
    EXPECT_DEATH(MakeWalk([&](WorldDescription& description) { description.success = name; }), "success");
    EXPECT_DEATH(MakeWalk([&](WorldDescription& description) { description.state[0].name = name; }), "state");
    EXPECT_DEATH(MakeWalk([&](WorldDescription& description) { description.figures[0].name = name; }),
                 "figures");
  }
}

TEST(WorldDeathTest, RefusesPlacesWhereThereAreNone) {
  const WalkWorld world;
  RandomStream stream = TestStream(9, 0);
  const std::vector<float> state = {0, 0};
  EXPECT_DEATH(world.DrawPlace(stream), "world.cc");
  EXPECT_DEATH(world.Towards(state, 0), "world.cc");
}

}  // namespace
}  // namespace fresco
