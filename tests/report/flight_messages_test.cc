// Compares what `fresco fly` publishes with what `fresco evaluate` prints of the same flight; and what a
// viewer gets to know of a field.
#include "msgs/flight_messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "msgs/experiment.h"
#include "msgs/worlds.h"
#include "report/result_display.h"
#include "tests/msgs/message_samples.h"
#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/aoi_figures.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/uav_fields.h"

namespace fresco {
namespace {

constexpr uint32_t kThisTest = 31;
const std::vector<std::string> kMoveNames = {"north", "south", "east", "west", "hover"};

Episode RandomFlight(const UavWorld& world, uint32_t index) {
  RandomStream stream = TestStream(kThisTest, index);
  return Fly(world, [&](const UavEnvironment& environment) {
    return RandomAction(world, environment, {index % 2 == 0, false}, &stream);
  });
}

void ExpectSameFlight(const UavWorld& world, const Episode& flight) {
  const auto json = nlohmann::json::parse(EpisodeJson(world.Tell(flight), "p"));
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
  EXPECT_EQ(messages.back().outcome, static_cast<int>(OutcomeOf(flight)));
  EXPECT_DOUBLE_EQ(reward, std::accumulate(flight.rewards.begin(), flight.rewards.end(), 0.0));
  EXPECT_FLOAT_EQ(messages.back().remaining_energy_j, json["residual_energy_j"].get<float>());
}

TEST(FlightMessages, AreTheFlightThatEvaluatePrints) {
  for (uint32_t index = 0; index < 200; ++index) {
    const UavWorld world(RandomScenario(index));
    ExpectSameFlight(world, RandomFlight(world, index));
  }
}

TEST(FlightMessages, SumTheAoiOfAWholeFlight) {
  const UavWorld world(TableOneScenario());
  const Episode flight = FlyBaseline(world, BaselineKind::kAoi);
  ExpectSameFlight(world, flight);
  const std::vector<flight_t> messages = FlightMessages(world, flight, "aoi");
  EXPECT_EQ(messages.size(), 70u);
  EXPECT_EQ(messages.back().total_aoi, Figures(world, flight).total_aoi);
  EXPECT_EQ(messages.front().remaining_energy_j, 22000);
}

TEST(FlightMessages, FitAFrameWhateverThePolicyIsCalled) {
  const UavWorld world(TableOneScenario());
  for (const flight_t& message :
       FlightMessages(world, FlyBaseline(world, BaselineKind::kDistance), std::string(5000, 'p'))) {
    flight_t decoded{};
    ASSERT_TRUE(Decode(Encoded(message), decoded));
    EXPECT_EQ(decoded.policy, std::string(kMaximumPolicyBytes, 'p'));
  }
}

/// Sensor n stands at (n, 2 n) metres and weighs 3 n + 1.
Scenario FieldOf(int sensors) {
  Scenario scenario = TableOne();
  for (int n = 0; n < sensors; ++n) {
    scenario.sensors.push_back({1.0 * n, 2.0 * n, 3.0 * n + 1});
  }
  return scenario;
}

TEST(ScenarioMessages, CarryEverySensorOnceAndInOrder) {
  for (const auto& [sensors, expected_messages] :
       {std::pair{1, 1}, {3, 1}, {24, 1}, {25, 2}, {48, 2}, {49, 3}, {250, 11}}) {
    const std::vector<scenario_t> messages = ScenarioMessages(UavWorld(FieldOf(sensors)));
    EXPECT_EQ(messages.size(), static_cast<size_t>(expected_messages));
    int next = 0;
    for (const scenario_t& message : messages) {
      EXPECT_EQ(message.total_sensors, sensors);
      EXPECT_EQ(message.first_sensor, next);
      scenario_t decoded{};
      ASSERT_TRUE(Decode(Encoded(message), decoded));
      for (size_t i = 0; i < decoded.x_m.size(); ++i, ++next) {
        EXPECT_EQ(decoded.x_m[i], next);
        EXPECT_EQ(decoded.y_m[i], 2 * next);
        EXPECT_EQ(decoded.weight[i], 3 * next + 1);
      }
    }
    EXPECT_EQ(next, sensors);
  }
}

TEST(ScenarioMessages, CarryEveryCellOfAMapOnceAndInOrder) {
  for (const auto& [rows, sensors, expected_messages] :
       {std::tuple{1, 3, 1}, {16, 3, 1}, {17, 3, 2}, {64, 1, 4}, {17, 49, 3}}) {
    std::vector<std::string> text(static_cast<size_t>(rows), "SRRRRRRRNNNNNNNNNNNNNNNNBBBBBBB.");
    text.back() = "SRRRRRRRRRRRRRRRRRRRRRRRRRRRRRRR";  // the southern row
    Scenario scenario = FieldOf(sensors);
    scenario.columns = 32;
    scenario.rows = rows;
    scenario.start = scenario.stop = {0, 0};
    scenario.map = std::make_shared<ObstacleMap>(text);
    const std::vector<scenario_t> messages = ScenarioMessages(UavWorld(scenario));
    EXPECT_EQ(messages.size(), static_cast<size_t>(expected_messages));
    size_t next = 0;
    int32_t heard = 0;
    for (const scenario_t& message : messages) {
      scenario_t decoded{};
      ASSERT_TRUE(Decode(Encoded(message), decoded));
      EXPECT_EQ(decoded.total_cells, 32 * rows);
      EXPECT_EQ(static_cast<size_t>(decoded.first_cell), next);
      EXPECT_EQ(decoded.first_sensor, heard);
      heard += decoded.sensor_count;
      for (const uint8_t kind : decoded.cell_kind) {
        EXPECT_EQ(kind, static_cast<uint8_t>(text[text.size() - 1 - next / 32][next % 32])) << next;
        ++next;
      }
    }
    EXPECT_EQ(next, static_cast<size_t>(32 * rows));
    EXPECT_EQ(heard, sensors);
  }
}

TEST(ScenarioMessages, AreThoseOfTheUavsWorldAndNoneOfAnother) {
  const Experiment uav = Experiment::Parse("", "the test");
  EXPECT_TRUE(HasFlights(uav));
  EXPECT_EQ(ScenarioMessages(uav).size(), 1);
  const Episode flight = uav.world().FlyReference("aoi", 0);
  EXPECT_EQ(FlightMessages(uav, flight, "aoi").size(), flight.states.size() / uav.world().state_size());
  const Experiment other = Experiment::Parse("cartpole {}", "the test");
  EXPECT_FALSE(HasFlights(other));
  EXPECT_TRUE(ScenarioMessages(other).empty());
}

TEST(FlightMessages, OfAFieldThatTheEpisodeDrewAreThoseOfThatField) {
  const Experiment drawn = Experiment::Parse(
      "scenario { random_sensors { per_episode: true minimum: 1 maximum: 4 } "
      "random_field { coverage_radius_m { minimum: 30 maximum: 90 } any_stop: true } }",
      "test");
  ASSERT_TRUE(HasFlights(drawn));
  EXPECT_TRUE(ScenarioMessages(drawn).empty());  // every episode has another one
  const UavFields& fields = *AsUavFields(drawn.world());
  for (const uint64_t seed : {1u, 2u, 3u}) {
    const UavWorld field(fields.Draw(seed), fields.options());
    const Episode in_field = field.FlyReference("aoi", 0);
    const Episode episode = drawn.world().FlyReference("aoi", seed);
    const std::vector<scenario_t> scenario = ScenarioMessages(drawn, episode);
    ASSERT_EQ(scenario.size(), 1u);
    EXPECT_EQ(Encoded(scenario[0]), Encoded(ScenarioMessages(field)[0]));
    const std::vector<flight_t> messages = FlightMessages(drawn, episode, "aoi");
    const std::vector<flight_t> expected = FlightMessages(field, in_field, "aoi");
    ASSERT_EQ(messages.size(), expected.size());
    for (size_t i = 0; i < messages.size(); ++i) {
      EXPECT_EQ(Encoded(messages[i]), Encoded(expected[i])) << i;
    }
  }
}

TEST(FlightMessagesDeathTest, AreNotThereInAnotherWorld) {
  const Experiment other = Experiment::Parse("cartpole {}", "the test");
  EXPECT_DEATH(FlightMessages(other, {}, "p"), "HasFlights");
}

TEST(ScenarioMessages, TellTheFieldAndTheFlight) {
  Scenario scenario = FieldOf(2);
  scenario.columns = 7;
  scenario.rows = 9;
  scenario.cell_m = 12.5;
  scenario.slots = 33;
  scenario.slot_s = 0.5;
  scenario.start = {1, 2};
  scenario.stop = {3, 4};
  scenario.coverage_radius_m = 60;
  scenario.initial_energy_j = 5000;
  const scenario_t uncapped = ScenarioMessages(UavWorld(scenario)).at(0);
  EXPECT_EQ(uncapped.columns, 7);
  EXPECT_EQ(uncapped.rows, 9);
  EXPECT_EQ(uncapped.cell_m, 12.5);
  EXPECT_EQ(uncapped.slots, 33);
  EXPECT_EQ(uncapped.slot_s, 0.5);
  EXPECT_EQ(uncapped.start_column, 1);
  EXPECT_EQ(uncapped.start_row, 2);
  EXPECT_EQ(uncapped.stop_column, 3);
  EXPECT_EQ(uncapped.stop_row, 4);
  EXPECT_EQ(uncapped.coverage_radius_m, 60);
  EXPECT_NEAR(uncapped.initial_energy_j, 5000, 1e-9);
  EXPECT_EQ(uncapped.maximum_aoi, 0);
  scenario.maximum_aoi = 20;
  EXPECT_EQ(ScenarioMessages(UavWorld(scenario)).at(0).maximum_aoi, 20);
}

}  // namespace
}  // namespace fresco
