// Worlds from shared libraries: a sound one, and every way in which one can misbehave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "plugins/plugin_world.h"
#include "tests/support/error_of.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kFaulty = FRESCO_PLUGIN_FOLDER "/faulty_world.so";

PluginSpec Spec(const std::string& settings, const std::string& library = kFaulty) {
  return {library, settings, 5};
}

/// Plays the episode of seed 3 with the action 0.
Episode Play(const PluginSpec& spec, uint64_t seed = 3) {
  const PluginWorld world(spec, DescribePlugin(spec));
  EpisodeRecorder recorder(world, seed);
  while (!recorder.ended()) {
    recorder.Step(0);
  }
  return recorder.Release();
}

TEST(Plugin, SaysWhatItsWorldIs) {
  const PluginDescription description = DescribePlugin(Spec(""));
  EXPECT_EQ(description.world.name, "faulty");
  ASSERT_EQ(description.world.state.size(), 2u);
  EXPECT_EQ(description.world.state[0].name, "steps");
  EXPECT_EQ(description.world.state[0].unit, "s");
  EXPECT_EQ(description.world.actions, (std::vector<std::string>{"go", "stay"}));
  EXPECT_EQ(description.world.longest_episode, 10);
  EXPECT_EQ(description.world.discount, 0.9);
  EXPECT_EQ(description.world.success, "walked");
  EXPECT_EQ(description.success_return, 5);
  EXPECT_FALSE(description.world.repeatable);
  EXPECT_TRUE(description.world.random);
  EXPECT_FALSE(DescribePlugin(Spec("no chance")).world.random);
}

TEST(Plugin, DescriptionsSurviveJson) {
  const PluginDescription description = DescribePlugin(Spec(""));
  EXPECT_EQ(ToJson(PluginDescriptionFrom(ToJson(description))), ToJson(description));
  EXPECT_THROW(PluginDescriptionFrom("{}"), Error);
  EXPECT_THROW(PluginDescriptionFrom("crash"), Error);
}

TEST(Plugin, IsPlayedLikeAnyWorld) {
  const Episode even = Play(Spec(""), 4);  // ends by itself after six steps
  EXPECT_EQ(even.ending, Ending::kTerminal);
  EXPECT_EQ(even.rewards, std::vector<float>(6, 1.0f));
  EXPECT_EQ(even.state(0)[1], 4.0f);
  EXPECT_EQ(even.state(6)[0], 6.0f);
  const Episode odd = Play(Spec(""), 3);  // is cut off after longest_episode steps
  EXPECT_EQ(odd.ending, Ending::kTruncated);
  EXPECT_EQ(odd.transitions(), 10);
}

TEST(Plugin, JudgesByTheReturn) {
  const PluginSpec spec = Spec("");
  const PluginWorld world(spec, DescribePlugin(spec));
  std::vector<double> figures(1);
  world.Judge(Play(spec, 4), figures);
  EXPECT_EQ(figures[0], 6.0);
  EXPECT_TRUE(world.Succeeded(Play(spec, 4)));
  EpisodeRecorder lazy(world, 4);
  while (!lazy.ended()) {
    lazy.Step(1);
  }
  EXPECT_FALSE(world.Succeeded(lazy.episode()));
}

TEST(Plugin, EnvironmentsDoNotDisturbOneAnother) {
  const PluginSpec spec = Spec("");
  const PluginWorld world(spec, DescribePlugin(spec));
  EpisodeRecorder one(world, 4);
  EpisodeRecorder other(world, 3);
  while (!one.ended()) {
    one.Step(0);
    other.Step(1);
  }
  EXPECT_TRUE(SameBits(one.episode(), Play(spec, 4)));
}

TEST(PluginRefused, IfItIsNone) {
  const auto error_of = [](const std::string& library) {
    return ErrorOf([&] { DescribePlugin(Spec("", library)); });
  };
  EXPECT_THAT(error_of("/no/such/library.so"), AllOf(HasSubstr("plugin.library"), HasSubstr("No such file")));
  EXPECT_THAT(error_of("/proc/self/exe"), HasSubstr("can't be loaded"));
  EXPECT_THAT(error_of("/etc/passwd"), AllOf(HasSubstr("/etc/passwd"), HasSubstr("can't be loaded")));
  EXPECT_THAT(error_of(FRESCO_PLUGIN_FOLDER "/other_abi_world.so"),
              AllOf(HasSubstr("version 3 of fresco/world.h"), HasSubstr("expected: version 2")));
}

TEST(PluginRefused, IfItsDescriptionIsAbsurd) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"no state", "state_size is 0; allowed: 1 to 10000"},
      {"a huge state", "state_size is 2000000000"},
      {"negative actions", "action_count is -1; allowed: 1 to 4000"},
      {"an endless episode", "longest_episode is 100001; allowed: 1 to 100000"},
      {"a discount of NaN", "discount is nan; allowed: 0 to 1"},
      {"half a chance", "without_chance is 2; allowed: 0 to 1"},
      {"no name", "name or success"},
      {"a bad name", "name or success"},
      {"a field without a name", "field 1 of the state has no name"},
      {"an action without a name", "action 1 has no name"},
      {"no description", "describe() returns null"},
      {"fail in create", "create() refuses the settings: failed on purpose"},
  };
  for (const auto& [fault, problem] : faults) {
    EXPECT_THAT(ErrorOf([&fault = fault] { DescribePlugin(Spec(fault)); }),
                AllOf(HasSubstr("faulty_world.so"), HasSubstr(problem)))
        << fault;
  }
}

// The library runs in another process, so this one lives on.
TEST(PluginRefused, IfItCrashesOrHangsWhileItIsAsked) {
  EXPECT_THAT(ErrorOf([] { DescribePlugin(Spec("crash in create")); }),
              AllOf(HasSubstr("faulty_world.so"), HasSubstr("crashed (segmentation fault) in create()")));
  EXPECT_THAT(ErrorOf([] { DescribePlugin(Spec("abort in describe")); }),
              HasSubstr("crashed (aborted) in describe()"));
  EXPECT_THAT(ErrorOf([] { DescribePlugin(Spec("throw in create")); }),
              HasSubstr("threw an exception in create(): thrown on purpose"));
  EXPECT_THAT(ErrorOf([] {
                DescribePlugin({kFaulty, "hang in describe", 0.1});
              }),
              HasSubstr("did not return in time in describe()"));
  EXPECT_THAT(ErrorOf([] { DescribePlugin(Spec("exit in create")); }), HasSubstr("fresco-world"));
}

TEST(PluginFails, WithTheLibraryAndTheCallInTheError) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"throw in make", "threw an exception in make(): thrown on purpose"},
      {"throw in reset", "threw an exception in reset(): thrown on purpose"},
      {"throw in step", "threw an exception in step(): thrown on purpose"},
      {"fail in make", "failed in make(): failed on purpose"},
      {"fail in reset", "failed in reset(): failed on purpose"},
      {"fail in step", "failed in step(): failed on purpose"},
      {"a state of NaN", "failed in step(): the state's steps is nan"},
      {"a reward of infinity", "failed in step(): the reward is inf"},
      {"a bad ending", "failed in step(): the ending is 9; allowed: 0 to 2"},
      {"an empty mask", "failed in step(): the mask"},
      {"a mask of nonsense", "failed in step(): the mask"},
  };
  for (const auto& [fault, problem] : faults) {
    try {
      Play(Spec(fault));
      ADD_FAILURE() << fault;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kPlugin) << fault;
      EXPECT_THAT(error.what(), AllOf(HasSubstr("faulty_world.so"), HasSubstr(problem))) << fault;
    }
  }
}

// What no exception can tell ends the process, with the exit status of a failed plug-in.
TEST(PluginEndsTheProcess, IfItCrashesOrHangs) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr int kStatus = static_cast<int>(ErrorKind::kPlugin);
  EXPECT_EXIT(Play(Spec("crash in step")), ::testing::ExitedWithCode(kStatus),
              "error: the plug-in .*faulty_world.so crashed \\(segmentation fault\\) in step\\(\\)");
  EXPECT_EXIT(Play(Spec("abort in reset")), ::testing::ExitedWithCode(kStatus),
              "crashed \\(aborted\\) in reset\\(\\)");
  EXPECT_EXIT(Play({kFaulty, "hang in step", 0.2}), ::testing::ExitedWithCode(kStatus),
              "did not return in time in step\\(\\)");
}

}  // namespace
}  // namespace fresco
