// Worlds in Python: a CartPole of thirty lines against the built-in one, and objects that misbehave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "core/installation.h"
#include "core/random.h"
#include "plugins/plugin_world.h"
#include "tests/support/error_of.h"
#include "worlds/cartpole/cartpole.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

using ::testing::HasSubstr;

PluginSpec Python(const std::string& object, double call_limit_s = 10) {
  return {(LibraryFolder() / "python_world.so").string(), object + "\n" FRESCO_PYTHON_FOLDER "\n500\n475",
          call_limit_s};
}

Episode PlayAtRandom(const World& world, uint64_t seed) {
  RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
  EpisodeRecorder recorder(world, seed);
  while (!recorder.ended()) {
    recorder.Step(RandomAllowedAction(recorder.mask(), stream));
  }
  return recorder.Release();
}

Episode PlayPython(const PluginSpec& spec, uint64_t seed = 1) {
  return PlayAtRandom(PluginWorld(spec, DescribePlugin(spec)), seed);
}

TEST(PythonWorld, SaysWhatItIs) {
  const PluginDescription plain = DescribePlugin(Python("pole:CartPole"));
  EXPECT_EQ(plain.world.name, "cartpole");
  EXPECT_TRUE(plain.world.random);
  EXPECT_FALSE(DescribePlugin(Python("pole:StillPole")).world.random);
  ASSERT_EQ(plain.world.state.size(), 4u);
  EXPECT_EQ(plain.world.state[3].name, "observation_3");
  EXPECT_EQ(plain.world.actions, (std::vector<std::string>{"action 0", "action 1"}));
  EXPECT_EQ(plain.world.longest_episode, 500);
  EXPECT_EQ(plain.success_return, 475);
  const PluginDescription named = DescribePlugin(Python("faulty:Sound"));
  EXPECT_EQ(named.world.state[1].name, "luck");
  EXPECT_EQ(named.world.actions[2], "right");
}

// The states on the wire are floats, so each step is compared by itself.
TEST(PythonWorld, StepsAsTheBuiltInCartPole) {
  const PluginSpec spec = Python("pole:CartPole");
  const PluginWorld python(spec, DescribePlugin(spec));
  int steps = 0;
  for (uint64_t seed = 0; seed < 30; ++seed) {
    const Episode episode = PlayAtRandom(python, seed);
    EXPECT_EQ(episode.ending, Ending::kTerminal);
    for (size_t i = 0; i < episode.actions.size(); ++i, ++steps) {
      const auto before = episode.state(i);
      const CartPole::State next = CartPole::After({before[0], before[1], before[2], before[3]},
                                                   episode.actions[i] == 1 ? 10.0 : -10.0);
      for (size_t field = 0; field < 4; ++field) {
        EXPECT_NEAR(episode.state(i + 1)[field], next[field], 1e-6);
      }
      EXPECT_EQ(CartPole::HasFailed(next), i + 1 == episode.actions.size());
      EXPECT_EQ(episode.rewards[i], 1.0f);
    }
  }
  EXPECT_GT(steps, 300);
}

TEST(PythonWorld, IsAFunctionOfSeedAndActions) {
  EXPECT_TRUE(SameBits(PlayPython(Python("pole:CartPole"), 5), PlayPython(Python("pole:CartPole"), 5)));
  EXPECT_FALSE(SameBits(PlayPython(Python("pole:CartPole"), 5), PlayPython(Python("pole:CartPole"), 6)));
}

TEST(PythonWorld, MayForbidActions) {
  const Episode episode = PlayPython(Python("faulty:Masked"));
  for (size_t i = 0; i < episode.actions.size(); ++i) {
    EXPECT_LE(episode.actions[i], i % 2 == 0 ? 1 : 0);
    EXPECT_EQ(episode.next_masks[i], i % 2 == 0 ? 0b001 : 0b011);
  }
}

TEST(PythonWorldRefused, IfTheObjectCantBeMade) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"nothing:CartPole", "No module named 'nothing'"},
      {"pole:Nothing", "has no attribute 'Nothing'"},
      {"faulty:WithoutSpaces", "observation_space"},
      {"faulty:NeedsArguments", "missing 1 required positional argument"},
      {"faulty:WithFewNames", "observation_names has 1 names for 2 values"},
  };
  for (const auto& [object, problem] : faults) {
    EXPECT_THAT(ErrorOf([&object = object] { DescribePlugin(Python(object)); }), HasSubstr(problem))
        << object;
  }
}

TEST(PythonWorldFails, WithTheCallAndPythonsReasonInTheError) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"faulty:RaisesInReset", "failed in reset(): ValueError: no start"},
      {"faulty:RaisesInStep", "failed in step(): KeyError: 'missing'"},
      {"faulty:ReturnsNan", "failed in step(): the state's steps is nan"},
      {"faulty:ReturnsNanReward", "failed in step(): the reward is nan"},
      {"faulty:ReturnsThree", "the observation has 3 values; expected 2"},
      {"faulty:ReturnsText", "the observation is no array of numbers"},
      {"faulty:ReturnsFour", "step() has to return (observation, reward, terminated, truncated, info)"},
  };
  for (const auto& [object, problem] : faults) {
    EXPECT_THAT(ErrorOf([&object = object] { PlayPython(Python(object)); }, ErrorKind::kPlugin),
                HasSubstr(problem))
        << object;
  }
}

TEST(PythonWorldEndsTheProcess, IfItSleeps) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(PlayPython(Python("faulty:Sleeps", 1)),
              ::testing::ExitedWithCode(static_cast<int>(ErrorKind::kPlugin)),
              "python_world.so did not return in time in step\\(\\)");
}

}  // namespace
}  // namespace fresco
