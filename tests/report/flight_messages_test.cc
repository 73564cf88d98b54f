// Compares what `fresco fly` publishes with what `fresco evaluate` prints of the same flight.
#include "msgs/flight_messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "report/result_display.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/baselines.h"

namespace fresco {
namespace {

constexpr uint32_t kThisTest = 31;
const std::vector<std::string> kMoveNames = {"north", "south", "east", "west", "hover"};

Episode RandomFlight(const World& world, uint32_t index) {
  RandomStream stream = TestStream(kThisTest, index);
  return Fly(world, [&](const Environment& environment) {
    return RandomAction(world, environment, {index % 2 == 0, false}, &stream);
  });
}

void ExpectSameFlight(const World& world, const Episode& flight) {
  const auto json = nlohmann::json::parse(FlightJson(world, flight, "p"));
  const std::vector<flight_t> messages = FlightMessages(world, flight, "p");
  ASSERT_EQ(messages.size(), json["flight"].size());
  double reward = 0;
  int64_t total_aoi = 0;
  for (size_t i = 0; i < messages.size(); ++i) {
    const nlohmann::json& slot = json["flight"][i];
    const flight_t& message = messages[i];
    EXPECT_EQ(message.slot, slot["slot"]);
    EXPECT_EQ(message.column, slot["column"]);
    EXPECT_EQ(message.row, slot["row"]);
    EXPECT_EQ(kMoveNames.at(static_cast<size_t>(message.move)), slot["move"]);
    EXPECT_EQ(message.scheduled, slot["scheduled"]);
    EXPECT_EQ(message.aoi, slot["aoi"].get<std::vector<int16_t>>());
    for (const int16_t aoi : message.aoi) {
      total_aoi += aoi;
    }
    EXPECT_EQ(message.total_aoi, total_aoi);
    EXPECT_EQ(message.outcome != 0, i + 1 == messages.size());
    reward += message.reward;
  }
  EXPECT_EQ(messages.back().outcome, static_cast<int>(flight.outcome));
  EXPECT_DOUBLE_EQ(reward, std::accumulate(flight.rewards.begin(), flight.rewards.end(), 0.0));
  EXPECT_FLOAT_EQ(messages.back().remaining_energy_j, json["residual_energy_j"].get<float>());
}

TEST(FlightMessages, AreTheFlightThatEvaluatePrints) {
  for (uint32_t index = 0; index < 200; ++index) {
    const World world(RandomScenario(index));
    ExpectSameFlight(world, RandomFlight(world, index));
  }
}

TEST(FlightMessages, SumTheAoiOfAWholeFlight) {
  const World world(TableOneScenario());
  const Episode flight = FlyBaseline(world, BaselineKind::kAoi);
  ExpectSameFlight(world, flight);
  const std::vector<flight_t> messages = FlightMessages(world, flight, "aoi");
  EXPECT_EQ(messages.size(), 70u);
  EXPECT_EQ(messages.back().total_aoi, Figures(world, flight).total_aoi);
  EXPECT_EQ(messages.front().remaining_energy_j, 22000);
}

TEST(FlightMessages, FitAFrameWhateverThePolicyIsCalled) {
  const World world(TableOneScenario());
  for (const flight_t& message :
       FlightMessages(world, FlyBaseline(world, BaselineKind::kDistance), std::string(5000, 'p'))) {
    std::vector<std::byte> bytes;
    Encode(message, bytes);
    flight_t decoded{};
    ASSERT_TRUE(Decode(bytes, decoded));
    EXPECT_EQ(decoded.policy, std::string(kMaximumPolicyBytes, 'p'));
  }
}

}  // namespace
}  // namespace fresco
