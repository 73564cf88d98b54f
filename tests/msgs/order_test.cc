// Episodes over the wire: in pieces that fit a frame, and back the same to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/random.h"
#include "msgs/order.h"
#include "tests/msgs/message_samples.h"
#include "tests/worlds/table_one.h"

namespace fresco {
namespace {

Scenario ScenarioWith(int sensors) {
  Scenario scenario = TableOne();
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, sensors, 4);
  return scenario;
}

/// A result with random masks.
OrderResult SampleResult(const World& world, RandomStream& stream) {
  OrderResult result = RandomResult(world, 12, {true, false}, stream);
  for (uint8_t& byte : result.episode.next_masks) {
    byte = static_cast<uint8_t>(stream.NextWord());
  }
  return result;
}

std::vector<transitions_t> Messages(const World& world, const OrderResult& result) {
  std::vector<transitions_t> messages;
  SplitResult(world, result, 5, [&](const transitions_t& message) {
    const std::vector<std::byte> bytes = Encoded(message);
    EXPECT_LE(bytes.size(), kMaximumMessageBytes);
    EXPECT_TRUE(Decode(bytes, messages.emplace_back()));
  });
  return messages;
}

class ResultCodec : public ::testing::TestWithParam<int> {};

TEST_P(ResultCodec, JoinsToTheSameResult) {
  const World world(ScenarioWith(GetParam()));
  RandomStream stream(static_cast<uint64_t>(GetParam()), RandomPurpose::kTest, 0, 0);
  const OrderResult result = SampleResult(world, stream);
  int next = 0;
  for (const transitions_t& message : Messages(world, result)) {
    EXPECT_EQ(message.actor_id, 5);
    OrderResult part;
    ASSERT_TRUE(FromWire(world, message, part));
    EXPECT_EQ(part.order_index, 12);
    ASSERT_EQ(part.first_transition, next);
    EXPECT_TRUE(IsPartOf(part.episode, next, result.episode));
    EXPECT_TRUE(std::equal(part.td_errors.begin(), part.td_errors.end(), result.td_errors.begin() + next));
    next += part.episode.transitions();
  }
  EXPECT_EQ(next, result.episode.transitions());
}

INSTANTIATE_TEST_SUITE_P(Sensors, ResultCodec, ::testing::Values(1, 3, 8, 60, 249, 250));

TEST(ResultCodecTest, RefusesValuesThatTheWorldCannotHave) {
  const World world(ScenarioWith(3));
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  const transitions_t good = Messages(world, SampleResult(world, stream)).front();
  const std::vector<std::function<void(transitions_t&)>> lies = {
      [](auto& m) { m.action[0] = 20; },
      [](auto& m) { m.action[1] = -1; },
      [](auto& m) { m.column[0] = 20; },
      [](auto& m) { m.row[2] = -1; },
      [](auto& m) { m.aoi[1][0] = 0; },
      [](auto& m) { m.aoi[1][2] = 71; },
      [](auto& m) { m.reward[0] = std::numeric_limits<float>::quiet_NaN(); },
      [](auto& m) { m.td_error[0] = std::nanf(""); },
      [](auto& m) { m.td_error[0] = -std::numeric_limits<float>::infinity(); },
      [](auto& m) { m.energy_margin_j[0] = std::numeric_limits<float>::infinity(); },
      [](auto& m) { m.first_transition = -1; },
      [](auto& m) { m.first_transition = 60; },
      [](auto& m) { m.outcome = 4; },
      [](auto& m) { m.order_index = -1; },
      [](auto& m) { m.sensor_count = 2; },
      [](auto& m) { m.mask_size = 2; },
      [](auto& m) { m.state_count = m.transition_count; },
  };
  OrderResult part;
  ASSERT_TRUE(FromWire(world, good, part));
  for (size_t i = 0; i < lies.size(); ++i) {
    transitions_t message = good;
    lies[i](message);
    EXPECT_FALSE(FromWire(world, message, part)) << i;
  }
}

}  // namespace
}  // namespace fresco
