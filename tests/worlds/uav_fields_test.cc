// Fields that are drawn for every episode, against UavWorld, which has one field.
#include "worlds/uav/uav_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/error.h"
#include "tests/worlds/table_one.h"
#include "worlds/episode.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

constexpr int kSeeds = 300;

FieldRanges SomeRanges() {
  return {{2, 5}, {0.5, 2}, {50, 125}, {50, 70}, true, true};
}

constexpr UavOptions kBothMasks{{true, true}, {}};

UavFields SomeFields() {
  return UavFields(TableOne(), SomeRanges(), kBothMasks);
}

void ExpectSameField(const Scenario& a, const Scenario& b) {
  EXPECT_EQ(a.slots, b.slots);
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.stop, b.stop);
  EXPECT_EQ(a.coverage_radius_m, b.coverage_radius_m);
  ASSERT_EQ(a.sensors.size(), b.sensors.size());
  for (size_t i = 0; i < a.sensors.size(); ++i) {
    EXPECT_EQ(a.sensors[i].x_m, b.sensors[i].x_m);
    EXPECT_EQ(a.sensors[i].y_m, b.sensors[i].y_m);
    EXPECT_EQ(a.sensors[i].weight, b.sensors[i].weight);
  }
}

/// A random flight; allowed actions only.
Episode RandomFlight(const World& world, uint64_t seed) {
  EpisodeRecorder recorder(world, seed);
  RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
  while (!recorder.ended()) {
    recorder.Step(RandomAllowedAction(recorder.mask(), stream));
  }
  return recorder.Release();
}

TEST(UavFields, AreDrawnWithinTheRangesAndReachTheirEnds) {
  const UavFields fields = SomeFields();
  std::set<int> sensors;
  std::set<int> slots;
  std::set<std::pair<int, int>> starts;
  std::set<std::pair<int, int>> stops;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Scenario field = fields.Draw(seed);
    sensors.insert(static_cast<int>(field.sensors.size()));
    slots.insert(field.slots);
    starts.insert({field.start.column, field.start.row});
    stops.insert({field.stop.column, field.stop.row});
    EXPECT_GE(field.coverage_radius_m, 50);
    EXPECT_LE(field.coverage_radius_m, 125);
    for (const Sensor& sensor : field.sensors) {
      EXPECT_GE(sensor.weight, 0.5);
      EXPECT_LE(sensor.weight, 2);
      for (const double place_m : {sensor.x_m, sensor.y_m}) {
        EXPECT_GE(place_m, -12.5);
        EXPECT_LE(place_m, 19 * 25 + 12.5);
      }
    }
  }
  EXPECT_THAT(sensors, testing::ElementsAre(2, 3, 4, 5));
  EXPECT_EQ(*slots.begin(), 50);
  EXPECT_EQ(*slots.rbegin(), 70);
  EXPECT_EQ(slots.size(), 21u);
  EXPECT_GT(starts.size(), 150u);  // of 400 cells
  EXPECT_GT(stops.size(), 150u);
}

TEST(UavFields, HaveTheScenariosStartAndStopUnlessTheseAreDrawn) {
  FieldRanges ranges = SomeRanges();
  ranges.any_start = ranges.any_stop = false;
  const UavFields fields(TableOne(), ranges);
  for (uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(fields.Draw(seed).start, TableOne().start);
    EXPECT_EQ(fields.Draw(seed).stop, TableOne().stop);
  }
}

TEST(UavFields, AreSaidByEveryState) {
  const UavFields fields = SomeFields();
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Episode episode = RandomFlight(fields, seed);
    for (size_t i = 0; i <= episode.actions.size(); ++i) {
      ExpectSameField(fields.FieldIn(episode.state(i)), fields.Draw(seed));
    }
  }
}

TEST(UavFields, AreFlownAsWorldsOfOneField) {
  const UavFields fields = SomeFields();
  int arrived = 0;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Episode episode = RandomFlight(fields, seed);
    const UavWorld field(fields.Draw(seed), kBothMasks);
    const Episode in_its_field = fields.InItsField(field, episode);
    Episode flown;
    ASSERT_TRUE(FlyActions(field, seed, in_its_field.actions, flown)) << seed;
    EXPECT_TRUE(SameBits(flown, in_its_field)) << seed;
    std::array<double, 3> figures{};
    std::array<double, 3> of_field{};
    fields.Judge(episode, figures);
    field.Judge(flown, of_field);
    EXPECT_EQ(figures, of_field);
    EXPECT_EQ(fields.Tell(episode).sentence, field.Tell(flown).sentence);
    EXPECT_EQ(fields.Succeeded(episode), field.Succeeded(flown));
    arrived += fields.Succeeded(episode) ? 1 : 0;
  }
  EXPECT_EQ(arrived, kSeeds);  // the mask keeps every stop within reach
}

TEST(UavFields, ForbidSensorsThatTheFieldDoesNotHave) {
  const UavFields fields(TableOne(), SomeRanges());  // without masks
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto sensors = static_cast<int>(fields.Draw(seed).sensors.size());
    const EpisodeRecorder recorder(fields, seed);
    for (int action = 0; action < fields.actions(); ++action) {
      EXPECT_EQ(recorder.mask()[static_cast<size_t>(action)], action % 6 <= sensors ? 1 : 0);
      EXPECT_EQ(fields.ActionAt(action, sensors).schedule, action % 6 <= sensors ? action % 6 : 0);
    }
  }
}

TEST(UavFields, AreSeenRelativeToTheUav) {
  FieldRanges ranges;
  ranges.sensors = {1, 2};
  ranges.weight = {3, 3};
  ranges.coverage_radius_m = {100, 100};
  ranges.slots = {70, 70};
  const UavFields fields(TableOne(), ranges);
  Scenario field = TableOne();
  field.sensors = {{310, 40, 3}};
  std::vector<float> state(fields.layout().size());
  fields.WriteField(field, state);
  state[kColumnField] = 10;
  state[kRowField] = 4;
  state[kTimeMarginField] = 35;
  state[kEnergyMarginField] = 5500;
  state[kAoiField] = 7;
  std::vector<float> seen(static_cast<size_t>(fields.observation_size()));
  fields.Observe(state, seen);
  // The UAV is over (250 m, 100 m), so the sensor is 60 m east, 60 m south; the longer side is 500 m.
  const auto distance = static_cast<float>(60 * std::sqrt(2.0) / 500);
  std::vector<float> expected = {0.5f, 0.2f, 0, 0.75f, 0.5f, 0.25f, 0.2f, 0.75f, 1, -1, -1, -1};
  expected.insert(expected.end(), {1, 0.12f, -0.12f, distance, 1, 0.1f, 1});
  // The radius is 100 m. After a move to the north or the west the sensor is 104 m away, otherwise 69 m.
  expected.insert(expected.end(), {0, -1, 0, 0, -1});
  expected.resize(expected.size() + 12);  // a sensor that the field does not have
  ASSERT_EQ(seen.size(), expected.size());
  for (size_t i = 0; i < seen.size(); ++i) {
    EXPECT_NEAR(seen[i], expected[i], 1e-6) << i;
  }
}

TEST(UavFields, HavePlacesForExcursions) {
  const UavFields fields = SomeFields();
  const UavWorld field(fields.Draw(1), kBothMasks);
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  RandomStream same(1, RandomPurpose::kTest, 0, 0);
  const EpisodeRecorder recorder(fields, 1);
  for (int i = 0; i < 100; ++i) {
    const int place = fields.DrawPlace(stream);
    ASSERT_EQ(place, field.DrawPlace(same));
    EXPECT_EQ(fields.IsAt(recorder.state(), place), field.IsAt(recorder.state(), place));
    const ActionRange range = fields.Towards(recorder.state(), place);
    EXPECT_EQ(range.end - range.first, 6);
    EXPECT_EQ(range.first / 6, field.Towards(recorder.state(), place).first / (field.sensors() + 1));
  }
}

TEST(UavFields, HaveTheBaselinesOfEachField) {
  const UavFields fields = SomeFields();
  ASSERT_EQ(fields.reference_policies().size(), 2u);
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const UavWorld field(fields.Draw(seed), kBothMasks);
    for (const ReferencePolicy& policy : fields.reference_policies()) {
      const Episode episode = fields.FlyReference(policy.name, seed);
      EXPECT_EQ(episode.seed, seed);
      EXPECT_TRUE(SameBits(fields.InItsField(field, episode), field.FlyReference(policy.name)));
      EXPECT_EQ(fields.GroupOf(episode), std::to_string(field.sensors()) + " sensors");
    }
  }
}

TEST(UavFields, AreSeenAsAWorldOfTheirFieldIsSeen) {
  const UavFields fields = SomeFields();
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const Episode episode = RandomFlight(fields, seed);
    const UavWorld field(fields.Draw(seed), {{true, true}, {.sets = true}});
    const Episode in_its_field = fields.InItsField(field, episode);
    std::vector<float> of_fields(static_cast<size_t>(fields.observation_size()));
    std::vector<float> of_field(static_cast<size_t>(field.observation_size()));
    for (size_t i = 0; i <= episode.actions.size(); ++i) {
      fields.Observe(episode.state(i), of_fields);
      field.Observe(in_its_field.state(i), of_field);
      ASSERT_TRUE(std::equal(of_field.begin(), of_field.end(), of_fields.begin())) << seed;
      EXPECT_TRUE(std::all_of(of_fields.begin() + static_cast<int64_t>(of_field.size()), of_fields.end(),
                              [](float entry) { return entry == 0; }));
    }
  }
}

TEST(UavFields, GoOnFromWhereAnotherEnvironmentIs) {
  const UavFields fields = SomeFields();
  const auto copy = fields.NewEnvironment();
  std::vector<float> state(static_cast<size_t>(fields.state_size()));
  std::vector<uint8_t> mask(static_cast<size_t>(fields.actions()));
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Episode episode = RandomFlight(fields, seed);
    const auto environment = fields.NewEnvironment();
    environment->Reset(seed);
    const size_t half = episode.actions.size() / 2;
    for (size_t i = 0; i < half; ++i) {
      environment->Step(episode.actions[i]);
    }
    copy->CopyFrom(*environment);
    for (size_t i = half; i < episode.actions.size(); ++i) {
      EXPECT_EQ(static_cast<float>(copy->Step(episode.actions[i]).reward), episode.rewards[i]);
      copy->WriteState(state);
      EXPECT_TRUE(std::equal(state.begin(), state.end(), episode.state(i + 1).begin()));
    }
    environment->WriteState(state);  // is where it was
    EXPECT_TRUE(std::equal(state.begin(), state.end(), episode.state(half).begin()));
  }
}

/// The text of the error if a policy for SomeFields does not serve this field; empty if it does.
std::string Refusal(const World& world, FieldRanges ranges = SomeRanges()) {
  try {
    UavFields(TableOne(), ranges, kBothMasks).CheckServes(world);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

Scenario SomeField() {
  Scenario field = TableOne();
  field.sensors = {{100, 100, 1}, {200, 300, 3}};
  return field;
}

TEST(UavFields, ServeFieldsWithinTheirRangesAndNameWhatIsNot) {
  EXPECT_EQ(Refusal(UavWorld(SomeField())), "");
  EXPECT_EQ(Refusal(SomeFields()), "");
  const auto with = [](auto change) {
    Scenario field = SomeField();
    change(field);
    return Refusal(UavWorld(field));
  };
  using testing::HasSubstr;
  EXPECT_THAT(
      with([](Scenario& field) { field.sensors.pop_back(); }),
      HasSubstr("the number of sensors (scenario.sensor) 1 is out of range; it was trained for 2 to 5"));
  EXPECT_THAT(with([](Scenario& field) { field.coverage_radius_m = 130; }),
              HasSubstr("scenario.coverage_radius_m 130 is out of range; it was trained for 50 to 125"));
  EXPECT_THAT(with([](Scenario& field) { field.slots = 71; }), HasSubstr("scenario.slots 71"));
  EXPECT_THAT(with([](Scenario& field) { field.columns = 21; }), HasSubstr("scenario.grid.columns 21"));
  EXPECT_THAT(with([](Scenario& field) { field.initial_energy_j = 20'000; }),
              HasSubstr("scenario.initial_energy_j 20000"));
  EXPECT_THAT(with([](Scenario& field) { field.maximum_aoi = 10; }), HasSubstr("scenario.maximum_aoi 10"));
  EXPECT_THAT(
      with([](Scenario& field) { field.sensors[0].weight = 0.5; }),
      HasSubstr("the ratio of two sensors' weights 3 : 0.5 is out of range; it was trained for at most 4"));
  EXPECT_EQ(with([](Scenario& field) { field.start = {3, 4}; }), "");
  FieldRanges one_start = SomeRanges();
  one_start.any_start = false;
  EXPECT_EQ(Refusal(UavWorld(SomeField()), one_start), "");
  Scenario elsewhere = SomeField();
  elsewhere.start = {3, 4};
  EXPECT_THAT(Refusal(UavWorld(elsewhere), one_start), HasSubstr("scenario.start (3, 4)"));
  EXPECT_THAT(Refusal(SomeFields(), one_start), HasSubstr("start and stop"));
  FieldRanges fewer = SomeRanges();
  fewer.sensors = {2, 4};
  EXPECT_THAT(Refusal(SomeFields(), fewer), HasSubstr("the number of sensors"));
}

}  // namespace
}  // namespace fresco
