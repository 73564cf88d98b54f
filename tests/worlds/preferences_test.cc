// WorldDescription::preferences against flights: what may be done and earned from a state may be done and
// earned from each that is as good.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/uav_fields.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

// Each mask, so that no flight fails: the preferences are about episodes that succeed.
constexpr UavOptions kBothMasks{{true, true}, {}};

/// Where a random beginning of an episode leads to.
struct Beginning {
  explicit Beginning(const World& world)
      : environment(world.NewEnvironment()),
        state(static_cast<size_t>(world.state_size())),
        mask(static_cast<size_t>(world.actions())) {}

  StepResult Step(int action) {
    const StepResult result = environment->Step(action);
    Look();
    return result;
  }
  void Look() {
    environment->WriteState(state);
    environment->WriteMask(mask);
  }

  std::unique_ptr<Environment> environment;
  std::vector<float> state;
  std::vector<uint8_t> mask;
};

bool IsAsGoodAs(const World& world, const Beginning& a, const Beginning& b) {
  for (size_t field = 0; field < a.state.size(); ++field) {
    const Preference preference = world.preference(field);
    const bool as_good = a.state[field] == b.state[field] ||
                         (preference == Preference::kLess && a.state[field] < b.state[field]) ||
                         (preference == Preference::kMore && a.state[field] > b.state[field]);
    if (!as_good) {
      return false;
    }
  }
  return true;
}

/// Flies at random behind `worse`, and does the same behind `better`.
void ExpectAsMuch(Beginning better, Beginning worse, RandomStream& stream) {
  for (Ending ending = Ending::kNone; ending == Ending::kNone;) {
    const int action = RandomAllowed(worse.mask, &stream);
    ASSERT_EQ(better.mask[static_cast<size_t>(action)], 1);
    const StepResult expected = worse.Step(action);
    const StepResult result = better.Step(action);
    EXPECT_GE(result.reward, expected.reward);
    ASSERT_EQ(result.ending, expected.ending);
    ending = result.ending;
  }
}

/// Tries all pairs of some beginnings of equal length. Returns how many different ones could be compared.
int TryPairs(const World& world, uint64_t seed, int length, RandomStream& stream) {
  constexpr int kBeginnings = 60;
  std::vector<std::vector<int>> actions(kBeginnings);
  const auto again = [&](const std::vector<int>& first) {
    Beginning beginning(world);
    beginning.environment->Reset(seed);
    beginning.Look();
    for (const int action : first) {
      beginning.Step(action);
    }
    return beginning;
  };
  for (std::vector<int>& first : actions) {
    Beginning beginning = again({});
    for (int step = 0; step < length; ++step) {
      first.push_back(RandomAllowed(beginning.mask, &stream));
      beginning.Step(first.back());
    }
  }
  int pairs = 0;
  for (const std::vector<int>& first : actions) {
    for (const std::vector<int>& second : actions) {
      Beginning better = again(first);
      Beginning worse = again(second);
      if (better.state != worse.state && IsAsGoodAs(world, better, worse)) {
        ++pairs;
        ExpectAsMuch(std::move(better), std::move(worse), stream);
      }
    }
  }
  return pairs;
}

TEST(Preferences, HoldOnOpenGridsAndOnMaps) {
  int pairs = 0;
  for (uint32_t index = 0; index < 40; ++index) {
    RandomStream stream = TestStream(50, index);
    const Scenario scenario = index % 2 == 0 ? RandomScenario(index) : RandomMapScenario(index);
    pairs += TryPairs(UavWorld(scenario, kBothMasks), 0, (scenario.slots - 1) / 2, stream);
  }
  EXPECT_GT(pairs, 1000);
}

TEST(Preferences, HoldInFieldsThatAreDrawn) {
  Scenario common = TableOne();
  common.columns = 4;
  common.rows = 4;
  common.slots = 14;
  common.start = {0, 0};
  common.stop = {3, 2};
  const UavFields fields(common, {{1, 4}, {0.5, 2}, {30, 60}, {12, 14}, true, true}, kBothMasks);
  int pairs = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream stream = TestStream(51, static_cast<uint32_t>(seed));
    pairs += TryPairs(fields, seed, 6, stream);
  }
  EXPECT_GT(pairs, 1000);
}

}  // namespace
}  // namespace fresco
