// Episodes over the wire: in pieces that fit a frame, and back the same to the bit.
#include "msgs/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/random.h"
#include "tests/msgs/message_samples.h"
#include "tests/worlds/table_one.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

/// A world of any size, to cut its episodes into messages; nobody acts in it.
class SizedWorld : public World {
 public:
  SizedWorld(int state_size, int actions) : World(Description(state_size, actions)) {}
  std::unique_ptr<Environment> NewEnvironment() const override { return nullptr; }
  void Observe(std::span<const float>, std::span<float>) const override {}
  void Judge(const Episode&, std::span<double>) const override {}
  bool Succeeded(const Episode&) const override { return false; }

 private:
  static WorldDescription Description(int state_size, int actions) {
    WorldDescription description;
    description.name = "sized";
    description.success = "done";
    description.state.resize(static_cast<size_t>(state_size), {"field", ""});
    description.actions.resize(static_cast<size_t>(actions), "action");
    description.observation_size = 1;
    description.longest_episode = kMaximumEpisode;
    description.figures = {{"figure", ""}};
    return description;
  }
};

float RandomFloat(RandomStream& stream) {
  return static_cast<float>(2000 * stream.NextUniform() - 1000);
}

std::vector<float> RandomFloats(RandomStream& stream, size_t count) {
  std::vector<float> values(count);
  std::generate(values.begin(), values.end(), [&] { return RandomFloat(stream); });
  return values;
}

/// A result with random values and random masks.
OrderResult SampleResult(const World& world, int transitions, RandomStream& stream) {
  const auto count = static_cast<size_t>(transitions);
  OrderResult result;
  result.order_index = 12;
  result.seed = 0xfedc'ba98'7654'3210;
  result.episode.ending = Ending::kTruncated;
  result.episode.states = RandomFloats(stream, (count + 1) * static_cast<size_t>(world.state_size()));
  result.episode.rewards = RandomFloats(stream, count);
  result.td_errors = RandomFloats(stream, count);
  for (size_t i = 0; i < count; ++i) {
    result.episode.actions.push_back(
        static_cast<int16_t>(stream.NextBelow(static_cast<uint32_t>(world.actions()))));
  }
  for (size_t i = 0; i < count * static_cast<size_t>(MaskSize(world.actions())); ++i) {
    result.episode.next_masks.push_back(static_cast<uint8_t>(stream.NextWord()));
  }
  return result;
}

std::vector<transitions_t> Messages(const World& world, const OrderResult& result) {
  std::vector<transitions_t> messages;
  SplitResult(world, result, 5, [&](const transitions_t& message) {
    const std::vector<std::byte> bytes = Encoded(message);
    EXPECT_LE(bytes.size(), kMaximumMessageBytes);
    EXPECT_LE(static_cast<size_t>(message.getEncodedSize()), kMaximumEncodedBytes);
    EXPECT_TRUE(Decode(bytes, messages.emplace_back()));
  });
  return messages;
}

/// Puts the parts of a result together, each value where its part says that it belongs.
class Joined {
 public:
  Joined(const World& world, int transitions)
      : state_size_(static_cast<size_t>(world.state_size())),
        mask_size_(static_cast<size_t>(MaskSize(world.actions()))) {
    const auto count = static_cast<size_t>(transitions);
    result.episode.states.assign((count + 1) * state_size_, std::nanf(""));
    result.episode.actions.assign(count, -1);
    result.episode.rewards.assign(count, std::nanf(""));
    result.episode.next_masks.assign(count * mask_size_, 0);
    result.td_errors.assign(count, std::nanf(""));
  }

  void Add(const OrderResult& part) {
    const auto first = static_cast<size_t>(part.first_transition);
    const auto count = static_cast<size_t>(part.episode.transitions());
    ASSERT_LE(first + count, result.episode.actions.size());
    const size_t fields = part.episode.states.size() / (count + 1);
    ASSERT_LE(static_cast<size_t>(part.first_field) + fields, state_size_);
    for (size_t i = 0; i <= count; ++i) {
      std::copy_n(part.episode.states.begin() + static_cast<ptrdiff_t>(i * fields), fields,
                  result.episode.states.begin() + static_cast<ptrdiff_t>((first + i) * state_size_) +
                      part.first_field);
    }
    std::copy(part.episode.actions.begin(), part.episode.actions.end(),
              result.episode.actions.begin() + part.first_transition);
    std::copy(part.episode.rewards.begin(), part.episode.rewards.end(),
              result.episode.rewards.begin() + part.first_transition);
    std::copy(part.episode.next_masks.begin(), part.episode.next_masks.end(),
              result.episode.next_masks.begin() + static_cast<ptrdiff_t>(first * mask_size_));
    std::copy(part.td_errors.begin(), part.td_errors.end(), result.td_errors.begin() + part.first_transition);
    if (part.episode.ending != Ending::kNone) {
      EXPECT_EQ(first + count, result.episode.actions.size()) << "only a part at the end ends the episode";
      result.episode.ending = part.episode.ending;
    }
  }

  OrderResult result;

 private:
  size_t state_size_;
  size_t mask_size_;
};

void ExpectRoundTrip(const World& world, int transitions, RandomStream& stream) {
  const OrderResult result = SampleResult(world, transitions, stream);
  Joined joined(world, transitions);
  std::pair<int, int> before = {-1, -1};
  for (const transitions_t& message : Messages(world, result)) {
    EXPECT_EQ(message.actor_id, 5);
    OrderResult part;
    ASSERT_TRUE(FromWire(world, message, part));
    EXPECT_EQ(part.order_index, 12);
    EXPECT_EQ(part.seed, result.seed);
    const std::pair<int, int> place = {part.first_transition, part.first_field};
    EXPECT_GT(place, before) << "first transitions first";
    before = place;
    joined.Add(part);
  }
  EXPECT_TRUE(SameBits(joined.result.episode, result.episode));
  EXPECT_EQ(joined.result.td_errors, result.td_errors);
}

constexpr int kStateSizes[] = {1,   2,   4,   7,   100, 128, 150,  151,  152,   153,
                               254, 299, 300, 301, 302, 600, 1000, 9999, 10'000};
constexpr int kActionCounts[] = {1, 2, 8, 9, 20, 1255, 3999, 4000};

TEST(ResultCodec, JoinsToTheSameResultInWorldsOfAnySize) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  for (const int state_size : kStateSizes) {
    for (const int actions : kActionCounts) {
      const SizedWorld world(state_size, actions);
      const int whole_message = LayoutOf(world).transitions;
      for (const int transitions : {1, whole_message, whole_message + 1, 3 * whole_message - 1}) {
        SCOPED_TRACE(testing::Message() << state_size << " fields, " << actions << " actions, " << transitions
                                        << " transitions");
        ExpectRoundTrip(world, transitions, stream);
      }
    }
  }
}

/// What a message takes, by LCM's format and the fields of transitions_t.lcm.
int BytesOf(int transitions, int fields, int actions) {
  constexpr int kFingerprint = 8;
  constexpr int kIdentity = 3 * 8;
  constexpr int kCounts = 4 * 4;
  constexpr int kOther = 3 * 8 + 2 * 4 + 1;  // order, actor and seed; two first numbers; the ending
  const int mask = (actions + 7) / 8;
  return kFingerprint + kIdentity + kCounts + kOther + (transitions + 1) * fields * 4 +
         transitions * (2 + 4 + 4 + mask);
}

TEST(MessageLayout, FillsAFrameAsFarAsItCan) {
  constexpr int kFrame = 1350 - 48;
  const auto expect = [&](int state_size, int actions) {
    const auto [transitions, fields] = LayoutOf(state_size, actions);
    EXPECT_LE(BytesOf(transitions, fields, actions), kFrame) << state_size << " " << actions;
    if (fields == state_size) {
      EXPECT_GE(transitions, 1);
      EXPECT_GT(BytesOf(transitions + 1, fields, actions), kFrame) << state_size << " " << actions;
    } else {
      EXPECT_EQ(transitions, 1);
      EXPECT_GE(fields, 1);
      EXPECT_GT(BytesOf(1, fields + 1, actions), kFrame) << state_size << " " << actions;
    }
    EXPECT_LE(transitions, kMaximumTransitionsPerMessage);
    EXPECT_LE(fields, transitions_t::MAXIMUM_FIELD_COUNT);
  };
  for (int state_size = 1; state_size <= kMaximumStateSize; state_size += state_size < 400 ? 1 : 97) {
    for (const int actions : kActionCounts) {
      expect(state_size, actions);
    }
  }
  for (int actions = 1; actions <= kMaximumActions; ++actions) {
    for (const int state_size : {1, 4, 7, 150, 300}) {
      expect(state_size, actions);
    }
  }
}

TEST(MessageLayout, KeepsTheStatesOfTheUavWhole) {
  for (const int sensors : {1, 3, 60, 130}) {  // 5 moves with any schedule; four fields and the AoI
    EXPECT_EQ(LayoutOf(4 + sensors, 5 * (sensors + 1)).fields, 4 + sensors) << sensors;
  }
}

UavWorld WorldWith(int sensors) {
  Scenario scenario = TableOne();
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, sensors, 4);
  return UavWorld(scenario);
}

TEST(ResultCodec, JoinsToTheSameFlight) {
  for (const int sensors : {1, 3, 8, 60, 249, 250}) {
    const UavWorld world = WorldWith(sensors);
    RandomStream stream(static_cast<uint64_t>(sensors), RandomPurpose::kTest, 0, 0);
    Order order;
    order.index = 12;
    const OrderResult result = RandomResult(world, order, stream);
    Joined joined(world, result.episode.transitions());
    for (const transitions_t& message : Messages(world, result)) {
      OrderResult part;
      ASSERT_TRUE(FromWire(world, message, part));
      joined.Add(part);
    }
    EXPECT_TRUE(SameBits(joined.result.episode, result.episode)) << sensors;
  }
}

void ExpectRefused(const World& world, const transitions_t& good,
                   const std::vector<std::function<void(transitions_t&)>>& lies) {
  OrderResult part;
  ASSERT_TRUE(FromWire(world, good, part));
  for (size_t i = 0; i < lies.size(); ++i) {
    transitions_t message = good;
    lies[i](message);
    EXPECT_FALSE(FromWire(world, message, part)) << i;
  }
}

TEST(ResultCodec, RefusesValuesThatTheWorldCannotHave) {
  const UavWorld world = WorldWith(3);
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  const transitions_t good = Messages(world, SampleResult(world, 69, stream)).front();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  ExpectRefused(world, good,
                {
                    [](auto& m) { m.action[0] = 20; },
                    [](auto& m) { m.action[1] = -1; },
                    [](auto& m) { m.state[0][0] = std::nanf(""); },
                    [](auto& m) { m.state.back()[6] = std::nanf(""); },
                    [](auto& m) { m.state[1][3] = kInfinity; },
                    [](auto& m) { m.reward[0] = std::nanf(""); },
                    [](auto& m) { m.reward.back() = kInfinity; },
                    [](auto& m) { m.td_error[0] = std::nanf(""); },
                    [](auto& m) { m.td_error[0] = -kInfinity; },
                    [](auto& m) { m.first_transition = -1; },
                    [](auto& m) { m.first_transition = 60; },
                    [](auto& m) { m.first_transition = std::numeric_limits<int32_t>::max(); },
                    [](auto& m) { m.first_field = 1; },
                    [](auto& m) { m.first_field = -1; },
                    [](auto& m) { m.first_field = 7; },
                    [](auto& m) { m.first_field = std::numeric_limits<int32_t>::max(); },
                    [](auto& m) { m.field_count = 6; },
                    [](auto& m) { m.field_count = 0; },
                    [](auto& m) { m.ending = 3; },
                    [](auto& m) { m.ending = -1; },
                    [](auto& m) { m.order_index = -1; },
                    [](auto& m) { m.mask_size = 2; },
                    [](auto& m) { m.state_count = m.transition_count; },
                    [](auto& m) { m.transition_count = 0; },
                });
}

TEST(ResultCodec, RefusesFieldsThatAreNoPartOfAWideState) {
  const SizedWorld world(1000, 2);
  const int step = LayoutOf(world).fields;
  ASSERT_LT(step, 500);
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  const std::vector<transitions_t> messages = Messages(world, SampleResult(world, 1, stream));
  ASSERT_GT(messages.size(), 2u);
  ExpectRefused(world, messages[1],
                {
                    [](auto& m) { m.first_field -= 1; }, [](auto& m) { m.first_field += 1; },
                    [](auto& m) { m.first_field = 1000; }, [](auto& m) { m.field_count -= 1; },
                    [=](auto& m) { m.first_field = 1000 / step * step; },  // has only the rest of them
                });
}

}  // namespace
}  // namespace fresco
