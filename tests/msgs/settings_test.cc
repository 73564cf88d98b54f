#include "msgs/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "msgs/channels.h"
#include "tests/msgs/uav_world_of.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

constexpr char kTwoSensors[] = "scenario { sensor { x_m: 1 y_m: 2 } sensor { x_m: 3 y_m: 4 } }";

Experiment With(const std::vector<std::string>& arguments, const std::string& text = "") {
  return Experiment::Parse(text, "test", ParseSettings(arguments));
}

std::string ErrorOfSetting(const std::string& argument, const std::string& text = "") {
  return ErrorOf([&] { With({argument}, text); });
}

TEST(Settings, AreSplitAtTheFirstEqualsSign) {
  EXPECT_THAT(
      ParseSettings({"schedule.seed=3", "run.lcm_url=udpm://1.2.3.4:5?ttl=0", "a="}),
      ElementsAre(Pair("schedule.seed", "3"), Pair("run.lcm_url", "udpm://1.2.3.4:5?ttl=0"), Pair("a", "")));
}

TEST(Settings, WithoutPathOrEqualsSignAreRefused) {
  for (const std::string argument : {"schedule.seed", "=3", ""}) {
    EXPECT_THAT(ErrorOf([&] { ParseSettings({argument}); }),
                AllOf(HasSubstr("path=value"), HasSubstr("\"" + argument + "\"")));
  }
}

TEST(Settings, ReachNestedFields) {
  const Experiment experiment = With({"schedule.seed=3", "agent.linear.initial=0.5", "agent.adam.beta1=0.8",
                                      "scenario.grid.columns=30", "agent.double_dqn=true"});
  EXPECT_EQ(experiment.schedule().seed(), 3u);
  EXPECT_EQ(experiment.agent().linear().initial(), 0.5);
  EXPECT_EQ(experiment.agent().linear().final(), 0.00001);
  EXPECT_FALSE(experiment.agent().has_exponential());
  EXPECT_EQ(experiment.agent().adam().beta1(), 0.8);
  EXPECT_EQ(UavWorldOf(experiment).scenario().columns, 30);
  EXPECT_TRUE(experiment.agent().double_dqn());
}

TEST(Settings, ReplaceWhatTheTextSaysAndTheLastOneCounts) {
  const std::string text =
      "agent { hidden_layers: [1, 2, 3] } schedule { seed: 5 } scenario { coverage_radius_m: 7 }";
  const Experiment experiment = With({"agent.hidden_layers=64,32", "schedule.seed=6", "schedule.seed=7",
                                      "scenario.transmit_power_w=0.07564"},
                                     text);
  EXPECT_THAT(experiment.agent().hidden_layers(), ElementsAre(64, 32));
  EXPECT_EQ(experiment.schedule().seed(), 7u);
  EXPECT_NEAR(UavWorldOf(experiment).scenario().coverage_radius_m, 100, 0.01);
}

TEST(Settings, TakeRepeatedValuesSeparatedByCommas) {
  EXPECT_THAT(With({"agent.hidden_layers=64,64"}).agent().hidden_layers(), ElementsAre(64, 64));
  EXPECT_THAT(With({"agent.hidden_layers=9"}).agent().hidden_layers(), ElementsAre(9));
}

TEST(Settings, ReachEntriesByTheirIndex) {
  const Experiment experiment =
      With({"scenario.sensor[1].x_m=30", "scenario.sensor[0].weight=5"}, kTwoSensors);
  EXPECT_EQ(UavWorldOf(experiment).scenario().sensors[0].x_m, 1);
  EXPECT_EQ(UavWorldOf(experiment).scenario().sensors[0].weight, 5);
  EXPECT_EQ(UavWorldOf(experiment).scenario().sensors[1].x_m, 30);
  EXPECT_EQ(UavWorldOf(experiment).scenario().sensors[1].y_m, 4);
}

TEST(Settings, RefuseIndexesThatAreNotThere) {
  for (const std::string path :
       {"scenario.sensor[2].x_m", "scenario.sensor[-1].x_m", "scenario.sensor[x].x_m",
        "scenario.sensor[0.x_m", "scenario.sensor[.x_m", "scenario.sensor[", "[", "scenario.sensor[].x_m",
        "scenario.sensor.x_m", "scenario[0].slots", "scenario.sensor[99999999999].x_m"}) {
    EXPECT_THAT(ErrorOfSetting(path + "=1", kTwoSensors), HasSubstr("--set " + path)) << path;
  }
  EXPECT_THAT(ErrorOfSetting("scenario.sensor[0].x_m=1"), HasSubstr("no such index"));
  EXPECT_THAT(ErrorOfSetting("scenario.sensor[x].x_m=1", kTwoSensors), HasSubstr("name[index]"));
}

TEST(Settings, RefuseAnIndexAtTheEndOfThePath) {
  for (const std::string path : {"agent.hidden_layers[0]", "schedule.seed[0]", "scenario.sensor[0]"}) {
    EXPECT_THAT(ErrorOfSetting(path + "=1"), HasSubstr("--set " + path)) << path;
  }
}

TEST(Settings, TakeStringsWithAndWithoutQuotes) {
  EXPECT_EQ(With({"run.lcm_url=memq://"}).run().lcm_url(), "memq://");
  EXPECT_EQ(With({"run.lcm_url=\"memq://\""}).run().lcm_url(), "memq://");
  EXPECT_EQ(With({"run.channel_prefix=A_b-9"}).run().channel_prefix(), "A_b-9");
}

TEST(Settings, NameAnUnknownFieldAndTheKnownOnes) {
  EXPECT_THAT(ErrorOfSetting("agent.bach_size=3"),
              AllOf(HasSubstr("--set agent.bach_size"), HasSubstr("batch_size")));
  EXPECT_THAT(ErrorOfSetting("nothing=3"),
              AllOf(HasSubstr("nothing"), HasSubstr(" has: scenario, cartpole, acrobot, "),
                    HasSubstr(", agent, schedule, run")));
  EXPECT_THAT(ErrorOfSetting("agent..x=3"), HasSubstr("--set agent..x"));
  EXPECT_THAT(ErrorOfSetting("schedule.seed.x=3"), HasSubstr("--set schedule.seed.x"));
}

TEST(Settings, NameTheNearestField) {
  const std::pair<const char*, const char*> kSlips[] = {{"agnet.hidden_layers=3", "agent.hidden_layers"},
                                                        {"agent.bach_size=3", "agent.batch_size"},
                                                        {"batch_size=3", "agent.batch_size"},
                                                        {"seed=3", "schedule.seed"},
                                                        {"schedule.hidden_layers=3", "agent.hidden_layers"},
                                                        {"agent.linear.inital=3", "agent.linear.initial"}};
  for (const auto& [given, meant] : kSlips) {
    EXPECT_THAT(ErrorOfSetting(given), HasSubstr(std::string("; did you mean ") + meant + "?")) << given;
  }
  EXPECT_THAT(ErrorOfSetting("scenario.sensor[0].wieght=3", kTwoSensors),
              HasSubstr("did you mean scenario.sensor[0].weight?"));
  EXPECT_THAT(ErrorOfSetting("nothing=3"), Not(HasSubstr("did you mean")));
}

TEST(Settings, NameTheValueThatIsNotOneOfTheField) {
  for (const std::string argument :
       {"schedule.seed=abc", "schedule.seed=-1", "schedule.seed=", "agent.batch_size=1.5",
        "agent.double_dqn=perhaps", "agent.hidden_layers=64,,64", "agent=3", "agent.batch_size=99999999999",
        "agent.hidden_layers=64,", "agent.hidden_layers=64] batch_size: 3 hidden_layers: [2",
        "run.lcm_url=a\"b", "run.lcm_url=\"a\" actors: 3", "schedule.seed=3 episodes: 4",
        "schedule.seed=3\nepisodes: 4"}) {
    const std::string path = argument.substr(0, argument.find('='));
    EXPECT_THAT(ErrorOfSetting(argument), AllOf(HasSubstr("--set " + path), HasSubstr("is not a value")))
        << argument;
  }
}

TEST(Settings, AreCheckedAgainstTheRangesLikeTheText) {
  EXPECT_THAT(ErrorOfSetting("agent.batch_size=0"),
              HasSubstr("agent.batch_size: 0 is out of range; allowed: 1 to 65536"));
}

TEST(ChannelNames, HaveThePrefix) {
  EXPECT_EQ(ChannelsWithPrefix("X").learner_status, "X_LEARNER_STATUS");
  for (const std::string& prefix :
       {std::string(), std::string(41, 'A'), std::string("A.*"), std::string("A B")}) {
    EXPECT_THAT(ErrorOf([&] { ChannelsWithPrefix(prefix); }), HasSubstr("run.channel_prefix: \"" + prefix));
  }
}

}  // namespace
}  // namespace fresco
