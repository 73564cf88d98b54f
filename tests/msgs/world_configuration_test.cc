// A configuration names its world; what the world does not have can't be asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msgs/experiment.h"
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
  for (const std::string option : {"safe_action_mask", "coverage_mask", "sensor_geometry"}) {
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

TEST(FlownReturnBound, IsRefusedInWorldsWithChance) {
  EXPECT_EQ(RefusalOf("acrobot {} agent { flown_return_bound: true }"),
            "my.textproto: agent.flown_return_bound: true; allowed: false, since in the world acrobot chance "
            "decides what an episode earns");
  EXPECT_NO_THROW(Configured("scenario {} agent { flown_return_bound: true }"));
}

TEST(SetNetworkOption, DecidesTheNetwork) {
  const Experiment experiment = Configured("agent { set_network {} }");
  // Six inputs of the UAV, seven of each of three sensors.
  EXPECT_EQ(experiment.network()->inputs(), 6 + 3 * 7);
  EXPECT_EQ(experiment.network()->outputs(), 20);
  EXPECT_EQ(experiment.network()->layer_sizes(),
            (std::vector<int>{13, 64, 64, 0, 134, 128, 128, 5, 0, 192, 64, 5}));
  EXPECT_EQ(Configured("scenario { random_sensors { count: 9 } } agent { set_network {} }")
                .network()
                ->layer_sizes(),
            experiment.network()->layer_sizes());
  const Experiment other =
      Configured("", {"agent.set_network.encoder_layers=8", "agent.set_network.trunk_layers=9,10",
                      "agent.set_network.head_layers=11,12"});
  EXPECT_EQ(other.network()->layer_sizes(), (std::vector<int>{13, 8, 0, 22, 9, 10, 5, 0, 18, 11, 12, 5}));
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
