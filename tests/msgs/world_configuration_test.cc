// A configuration names its world; what the world does not have can't be asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msgs/experiment.h"
#include "msgs/worlds.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

Experiment Configured(const std::string& text, const std::vector<std::string>& settings = {}) {
  return Experiment::Parse(text, "my.textproto", ParseSettings(settings));
}

std::string RefusalOf(const std::string& text, const std::vector<std::string>& settings = {}) {
  return ErrorOf([&] { Configured(text, settings); });
}

std::string WorldOf(const Experiment& experiment) {
  return experiment.world().description().name;
}

TEST(WorldConfiguration, NamesTheWorld) {
  EXPECT_EQ(WorldOf(Configured("")), "uav");
  EXPECT_EQ(WorldOf(Configured("scenario {}")), "uav");
  EXPECT_EQ(WorldOf(Configured("cartpole {}")), "cartpole");
  EXPECT_EQ(WorldOf(Configured("acrobot {}")), "acrobot");
}

TEST(WorldConfiguration, DecidesTheNetwork) {
  EXPECT_EQ(Configured("cartpole {}").network()->layer_sizes(), (std::vector<int>{4, 200, 256, 2}));
  EXPECT_EQ(Configured("acrobot {}").network()->layer_sizes(), (std::vector<int>{6, 200, 256, 3}));
}

TEST(WorldConfiguration, OfABuiltInWorldHasARange) {
  EXPECT_EQ(Configured("cartpole {}").world().longest_episode(), 500);
  EXPECT_EQ(Configured("cartpole { maximum_steps: 9 }").world().longest_episode(), 9);
  EXPECT_EQ(Configured("acrobot { maximum_steps: 100000 }").world().longest_episode(), 100'000);
  EXPECT_EQ(RefusalOf("cartpole { maximum_steps: 0 }"),
            "my.textproto: cartpole.maximum_steps: 0 is out of range; allowed: 1 to 100000");
  EXPECT_EQ(RefusalOf("acrobot {}", {"acrobot.maximum_steps=100001"}),
            "my.textproto: acrobot.maximum_steps: 100001 is out of range; allowed: 1 to 100000");
}

TEST(WorldConfiguration, WithTwoWorldsIsRefusedWithTheLine) {
  EXPECT_THAT(RefusalOf("scenario {}\ncartpole {}"),
              AllOf(StartsWith("my.textproto:2:"), HasSubstr("cartpole"), HasSubstr("scenario")));
  EXPECT_THAT(RefusalOf("acrobot {}\n\n  cartpole {}"),
              AllOf(StartsWith("my.textproto:3:"), HasSubstr("cartpole"), HasSubstr("acrobot")));
}

TEST(WorldSetting, ChangesTheWorldOfTheText) {
  EXPECT_EQ(Configured("cartpole {}", {"cartpole.maximum_steps=9"}).world().longest_episode(), 9);
  EXPECT_EQ(Configured("scenario { slots: 40 }", {"scenario.slots=30"}).world().longest_episode(), 29);
  EXPECT_EQ(WorldOf(Configured("", {"acrobot.maximum_steps=9"})), "acrobot");
}

TEST(WorldSetting, NeverReplacesTheWorldOfTheText) {
  EXPECT_EQ(
      RefusalOf("scenario { slots: 40 }", {"cartpole.maximum_steps=9"}),
      "--set cartpole.maximum_steps: the world of my.textproto is scenario, and a setting can't replace "
      "it; choose a configuration of the world cartpole with --config");
  EXPECT_THAT(RefusalOf("cartpole {}", {"scenario.sensor[0].x_m=9"}),
              HasSubstr("the world of my.textproto is cartpole"));
  EXPECT_THAT(RefusalOf("acrobot {}", {"cartpole=9"}), HasSubstr("the world of my.textproto is acrobot"));
  EXPECT_THAT(RefusalOf("", {"cartpole.maximum_steps=9", "acrobot.maximum_steps=9"}),
              HasSubstr("--set acrobot.maximum_steps: the world of my.textproto is cartpole"));
}

TEST(WorldSetting, LeavesOtherAlternativesReplaceable) {
  const Experiment experiment = Configured("cartpole {} agent { exponential {} }",
                                           {"agent.linear.initial=0.5", "schedule.ladder.rungs=3"});
  EXPECT_EQ(experiment.agent().linear().initial(), 0.5);
  EXPECT_EQ(experiment.schedule().ladder().rungs(), 3);
}

TEST(Discount, IsThatOfTheWorldUnlessSaid) {
  EXPECT_EQ(Configured("scenario {}").agent().discount(), 1);
  EXPECT_EQ(Configured("cartpole {}").agent().discount(), 0.99);
  EXPECT_EQ(Configured("acrobot {}").agent().discount(), 0.99);
  EXPECT_EQ(Configured("cartpole {} agent { discount: 0.5 }").agent().discount(), 0.5);
  EXPECT_EQ(Configured("cartpole {} agent { discount: 0 }").agent().discount(), 0);
  EXPECT_THAT(Configured("cartpole {}").Text(), HasSubstr("discount: 0.99"));
  EXPECT_EQ(Configured("cartpole {}").hash(), Configured("cartpole {} agent { discount: 0.99 }").hash());
}

TEST(AgentOption, OfTheUavIsRefusedInOtherWorlds) {
  for (const std::string option : {"safe_action_mask", "coverage_mask", "idle_mask", "sensor_geometry"}) {
    EXPECT_EQ(RefusalOf("cartpole {} agent { " + option + ": true }"),
              "my.textproto: agent." + option +
                  ": true; allowed: false, since only the world scenario has this option and the world is "
                  "cartpole");
    EXPECT_NO_THROW(Configured("cartpole {} agent { " + option + ": false }"));
    EXPECT_NO_THROW(Configured("scenario {} agent { " + option + ": true }"));
  }
}

TEST(ExcursionShare, IsRefusedInWorldsWithoutPlaces) {
  EXPECT_EQ(RefusalOf("cartpole {} schedule { excursion_share: 0.25 }"),
            "my.textproto: schedule.excursion_share: 0.25 is out of range; allowed: 0, since the world "
            "cartpole has no places to set out for");
  EXPECT_NO_THROW(Configured("acrobot {} schedule { excursion_share: 0 }"));
  EXPECT_NO_THROW(Configured("scenario {} schedule { excursion_share: 0.25 }"));
}

TEST(FlownReturnBound, IsAllowedInWorldsWithoutChance) {
  for (const char* world :
       {"scenario {}", "acrobot {}", "cartpole {}", "scenario { random_sensors { per_episode: true } }"}) {
    EXPECT_NO_THROW(Configured(std::string(world) + " agent { flown_return_bound: true }")) << world;
  }
}

TEST(FieldsOfEpisodes, HaveTheRangesOfTheConfiguration) {
  const Experiment experiment = Configured(R"(scenario {
    random_sensors { per_episode: true minimum: 2 maximum: 4 }
    random_field { slots { minimum: 60 maximum: 70 } coverage_radius_m { minimum: 50 maximum: 125 } any_start: true }
  })");
  const World& world = experiment.world();
  EXPECT_EQ(world.actions(), 5 * (1 + 4));
  EXPECT_EQ(world.longest_episode(), 69);
  EXPECT_EQ(world.observation_size(), 12 + 4 * 12);
  EXPECT_TRUE(world.description().random);
  EXPECT_TRUE(HasFlights(experiment));
  EXPECT_EQ(Configured("scenario { random_sensors { per_episode: true count: 6 } }").world().actions(),
            5 * (1 + 6));
}

TEST(FieldsOfEpisodes, AreRefusedWithTheFieldThatIsWrong) {
  const auto refusal = [](const std::string& sensors, const std::string& field) {
    return RefusalOf("scenario { random_sensors { " + sensors + " } " + field + " }");
  };
  const std::string per_episode = "per_episode: true";
  EXPECT_THAT(refusal("minimum: 2", ""),
              HasSubstr("random_sensors: minimum, maximum: only for fields that are drawn"));
  EXPECT_THAT(refusal("", "random_field { any_stop: true }"),
              HasSubstr("scenario.random_field: only for fields"));
  EXPECT_THAT(refusal(per_episode + " minimum: 4 maximum: 2", ""),
              HasSubstr("random_sensors: minimum and maximum: 4 to 2"));
  EXPECT_THAT(refusal(per_episode, "random_field { slots { minimum: 60 } }"),
              HasSubstr("scenario.random_field.slots: expected a minimum and a maximum"));
  EXPECT_THAT(refusal(per_episode, "random_field { slots { minimum: 60.5 maximum: 70 } }"),
              HasSubstr("scenario.random_field.slots: expected whole numbers, found 60.5"));
  EXPECT_THAT(refusal(per_episode, "random_field { slots { minimum: 60 maximum: 1e300 } }"),
              HasSubstr("whole numbers"));
  EXPECT_THAT(refusal(per_episode, "random_field { slots { minimum: nan maximum: 70 } }"),
              HasSubstr("whole numbers"));
  EXPECT_THAT(
      refusal(per_episode, "random_field { slots { minimum: 30 maximum: 70 } any_stop: true }"),
      HasSubstr("scenario.random_field.slots: 30 is out of range: a stop may be 38 moves from the start"));
  EXPECT_THAT(refusal(per_episode, "random_field { weight { minimum: 0 maximum: 1 } }"),
              HasSubstr("scenario.random_field.weight: 0 to 1 is out of range"));
  EXPECT_THAT(refusal(per_episode, "random_field { coverage_radius_m { minimum: nan maximum: 1 } }"),
              HasSubstr("scenario.random_field.coverage_radius_m: nan to 1"));
  EXPECT_THAT(refusal(per_episode, "initial_energy_j: 5000"),
              HasSubstr("scenario.initial_energy_j: 5000 is out of range"));
}

TEST(SetNetworkOption, DecidesTheNetwork) {
  const Experiment experiment = Configured("agent { set_network {} }");
  // Twelve inputs of the UAV, twelve of each of three sensors.
  EXPECT_EQ(experiment.network()->inputs(), 12 + 3 * 12);
  EXPECT_EQ(experiment.network()->outputs(), 20);
  EXPECT_EQ(experiment.network()->layer_sizes(),
            (std::vector<int>{24, 64, 64, 0, 140, 128, 128, 5, 0, 192, 64, 5}));
  EXPECT_EQ(Configured("scenario { random_sensors { count: 9 } } agent { set_network {} }")
                .network()
                ->layer_sizes(),
            experiment.network()->layer_sizes());
  const Experiment other =
      Configured("", {"agent.set_network.encoder_layers=8", "agent.set_network.trunk_layers=9,10",
                      "agent.set_network.head_layers=11,12"});
  EXPECT_EQ(other.network()->layer_sizes(), (std::vector<int>{24, 8, 0, 28, 9, 10, 5, 0, 18, 11, 12, 5}));
  const Experiment again = Configured(other.Text());
  EXPECT_EQ(again.Text(), other.Text());
  EXPECT_EQ(again.hash(), other.hash());
}

TEST(SetNetworkOption, IsRefusedInWorldsWithoutSets) {
  EXPECT_EQ(RefusalOf("cartpole {} agent { set_network {} }"),
            "my.textproto: agent.set_network: set; allowed: omitted, since the world cartpole has no "
            "observation that is made of a set of items");
}

TEST(SetNetworkOption, IsRefusedBesideHiddenLayers) {
  EXPECT_EQ(
      RefusalOf("agent { hidden_layers: [8, 9] set_network {} }"),
      "my.textproto: agent.hidden_layers (2 given) and agent.set_network contradict each other; allowed: "
      "one of the two");
}

TEST(SetNetworkOption, HasLimits) {
  EXPECT_THAT(RefusalOf("agent { set_network { trunk_layers: 0 } }"),
              HasSubstr("agent.set_network.trunk_layers[0]: 0 is out of range; allowed: 1 to 8192"));
  EXPECT_THAT(RefusalOf("agent { set_network { head_layers: [1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1] } }"),
              HasSubstr("agent.set_network.head_layers: 17 layers; allowed: at most 16"));
  EXPECT_THAT(RefusalOf("agent { set_network { trunk_layers: [8192, 8192] } }"),
              AllOf(HasSubstr("agent.set_network: "), HasSubstr("parameters of the network; allowed: at most "
                                                                "10000000")));
  EXPECT_THAT(
      RefusalOf("scenario { random_sensors { count: 250 } } agent { set_network {} batch_size: 4096 }"),
      HasSubstr("agent.batch_size: 4096 columns of "));
}

TEST(EvaluationEpisodes, HaveARange) {
  EXPECT_EQ(Configured("").schedule().evaluation_episodes(), 1);
  EXPECT_THAT(RefusalOf("schedule { evaluation_episodes: 0 }"),
              HasSubstr("schedule.evaluation_episodes: 0 is out of range; allowed: 1 to 1000"));
}

TEST(WorldText, ReadsAsTheSameWorld) {
  for (const std::string text :
       {"cartpole { maximum_steps: 9 }", "acrobot {}", "scenario { slots: 40 sensor { x_m: 3 } }"}) {
    const Experiment experiment = Configured(text + " agent { hidden_layers: 3 }");
    const Experiment again = Configured(experiment.Text());
    EXPECT_EQ(again.Text(), experiment.Text());
    EXPECT_EQ(again.hash(), experiment.hash());
    EXPECT_EQ(Configured(experiment.WorldText()).WorldText(), experiment.WorldText());
  }
}

}  // namespace
}  // namespace fresco
