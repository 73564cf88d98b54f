#include "worlds/uav/uav_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

#include "core/error.h"
#include "worlds/uav/flight.h"
#include "worlds/uav/uav_environment.h"
#include "worlds/uav/uav_formulas.h"

namespace fresco {
namespace {

/// Rounded to the precision of a state, so that a state says the field exactly.
double AsInAState(double value) {
  return static_cast<float>(value);
}

int DrawInteger(Interval<int> range, RandomStream& stream) {
  return range.minimum +
         static_cast<int>(stream.NextBelow(static_cast<uint32_t>(range.maximum - range.minimum + 1)));
}

double DrawNumber(Interval<double> range, RandomStream& stream) {
  return AsInAState(range.minimum + (range.maximum - range.minimum) * stream.NextUniform());
}

Cell DrawCell(const Scenario& scenario, RandomStream& stream) {
  const auto column = static_cast<int>(stream.NextBelow(static_cast<uint32_t>(scenario.columns)));
  return {column, static_cast<int>(stream.NextBelow(static_cast<uint32_t>(scenario.rows)))};
}

/// A field with the most sensors and slots: its states, actions and limits are those of all fields.
Scenario Largest(Scenario scenario, const FieldRanges& ranges) {
  scenario.sensors.assign(static_cast<size_t>(std::max(ranges.sensors.maximum, 0)), Sensor{});
  scenario.coverage_radius_m = ranges.coverage_radius_m.maximum;
  scenario.slots = ranges.slots.maximum;
  return scenario;
}

template <class Number>
void CheckInterval(const char* path, Interval<Number> range, Number least, Number most) {
  if (!(range.minimum >= least && range.minimum <= range.maximum && range.maximum <= most)) {
    throw UsageError(
        fmt::format("{}: {} to {} is out of range; allowed: a minimum of at least {} that is not above "
                    "the maximum, which is at most {}",
                    path, range.minimum, range.maximum, least, most));
  }
}

const FieldRanges& CheckedRanges(const FieldRanges& ranges) {
  CheckInterval("scenario.random_sensors: minimum and maximum", ranges.sensors, 1, kMaximumSensors);
  CheckInterval("scenario.random_field.weight", ranges.weight, 1e-6, 1e6);
  CheckInterval("scenario.random_field.coverage_radius_m", ranges.coverage_radius_m, 0.0, 1e6);
  CheckInterval("scenario.random_field.slots", ranges.slots, 2, 10'000);
  return ranges;
}

WorldDescription DescribeFields(const Scenario& common, const FieldRanges& ranges,
                                const UavOptions& options) {
  WorldDescription description = UavWorld(Largest(common, CheckedRanges(ranges)), options).description();
  description.random = true;
  description.chance = false;
  description.state.insert(description.state.end(), {{"slots", "slots"},
                                                     {"coverage_radius_m", "m"},
                                                     {"start_column", "cells"},
                                                     {"start_row", "cells"},
                                                     {"stop_column", "cells"},
                                                     {"stop_row", "cells"}});
  for (int sensor = 1; sensor <= ranges.sensors.maximum; ++sensor) {
    description.state.push_back({fmt::format("sensor_{}_x_m", sensor), "m"});
    description.state.push_back({fmt::format("sensor_{}_y_m", sensor), "m"});
    description.state.push_back({fmt::format("sensor_{}_weight", sensor), ""});
  }
  description.preferences.resize(description.state.size(), Preference::kOnlyEqual);
  description.sets = SetsOf(ranges.sensors.maximum);
  description.observation_size = NetworkInput::Size(ranges.sensors.maximum, {.sets = true});
  return description;
}

/// Draws a field in Reset and flies in it.
class UavFieldsEnvironment : public Environment {
 public:
  explicit UavFieldsEnvironment(const UavFields& fields)
      : fields_(&fields), field_part_(fields.layout().size()) {}

  void Reset(uint64_t seed) override {
    field_ = fields_->WorldOf(seed);
    environment_.emplace(*field_);
    field_mask_.resize(static_cast<size_t>(field_->actions()));
    fields_->WriteField(field_->scenario(), field_part_);
  }

  void CopyFrom(const Environment& other) override {
    const auto& from = static_cast<const UavFieldsEnvironment&>(other);
    field_mask_.resize(from.field_mask_.size());
    environment_ = from.environment_;
    if (field_ != from.field_) {
      field_ = from.field_;
      field_part_ = from.field_part_;
    }
  }

  StepResult Step(int action) override {
    return environment_->Step(fields_->ActionAt(action, field_->sensors()));
  }

  void WriteState(std::span<float> state) const override {
    std::copy(field_part_.begin(), field_part_.end(), state.begin());
    environment_->WriteState(state.first(static_cast<size_t>(field_->state_size())));
  }

  void WriteMask(std::span<uint8_t> mask) const override {
    environment_->WriteMask(field_mask_);
    const auto here = static_cast<size_t>(field_->sensors()) + 1;
    const auto all = static_cast<size_t>(fields_->schedules());
    std::fill(mask.begin(), mask.end(), uint8_t{0});
    for (size_t move = 0; move < kMoves; ++move) {
      std::copy_n(field_mask_.begin() + static_cast<int64_t>(move * here), here,
                  mask.begin() + static_cast<int64_t>(move * all));
    }
  }

 private:
  const UavFields* fields_;
  std::shared_ptr<const UavWorld> field_;  // copies share it
  std::optional<UavEnvironment> environment_;
  std::vector<float> field_part_;  // a state with nothing but the field
  mutable std::vector<uint8_t> field_mask_;
};

}  // namespace

UavFields::UavFields(Scenario common, FieldRanges ranges, UavOptions options)
    : World(DescribeFields(common, ranges, options)),
      common_(std::move(common)),
      ranges_(ranges),
      options_{options.mask, {}} {
  CheckEveryStopIsReachable();
  if (common_.map != nullptr) {
    RandomSensors(common_, ranges_.sensors.maximum, 0);  // throws if there are too few cells
    map_input_.emplace(*common_.map, common_.cell_m, ranges_.coverage_radius_m.maximum);
  }
}

/// The cells from which starts and stops are drawn. There must be a map.
const std::vector<Cell>& UavFields::CellsToDraw() const {
  const std::vector<Cell>& zones = common_.map->zones();
  return zones.empty() ? common_.map->CellsAround(common_.start) : zones;
}

/// The distances from a start to a stop that can be drawn, in ascending order.
std::vector<int> UavFields::DistancesToStops(const UavWorld& largest) const {
  std::vector<int> distances;
  if (!ranges_.any_start && !ranges_.any_stop) {
    distances = {largest.DistanceToStop(common_.start)};
  } else if (common_.map == nullptr) {
    distances.resize(static_cast<size_t>(common_.columns + common_.rows - 1));
    std::iota(distances.begin(), distances.end(), 0);
  } else {
    const std::vector<Cell> starts = ranges_.any_start ? CellsToDraw() : std::vector<Cell>{common_.start};
    const std::vector<Cell> stops = ranges_.any_stop ? CellsToDraw() : std::vector<Cell>{common_.stop};
    std::vector<uint8_t> found(ObstacleMap::kCutOff + 1);
    for (const Cell start : starts) {
      for (const Cell stop : stops) {
        const int distance = common_.map->Distance(start, stop);
        if (distance == ObstacleMap::kCutOff) {
          throw UsageError(
              fmt::format("scenario.random_field: a start in column {}, row {} and a stop in column {}, row "
                          "{} are cut off from "
                          "each other by the obstacles of scenario.map_row; allowed: only starts and stops "
                          "between which the "
                          "UAV can fly",
                          start.column, start.row, stop.column, stop.row));
        }
        if (std::exchange(found[static_cast<size_t>(distance)], uint8_t{1}) == 0) {
          distances.push_back(distance);
        }
      }
    }
    std::sort(distances.begin(), distances.end());
  }
  return distances;
}

void UavFields::CheckEveryStopIsReachable() const {
  const UavWorld largest(Largest(common_, ranges_), options_);
  const std::vector<int> distances = DistancesToStops(largest);
  const int farthest = distances.back();
  for (int slots = ranges_.slots.minimum; slots <= ranges_.slots.maximum; ++slots) {
    if (farthest > slots - 1) {
      throw UsageError(
          fmt::format("scenario.random_field.slots: {} is out of range: a stop may be {} moves from the "
                      "start; allowed: at least {}",
                      slots, farthest, farthest + 1));
    }
    for (const int distance : distances) {
      const double needed_j = CompletionEnergy(largest, distance, slots - 1);
      if (needed_j > common_.initial_energy_j) {
        throw UsageError(
            fmt::format("scenario.initial_energy_j: {} is out of range: a flight of {} slots to a stop {} "
                        "moves away takes {:.6g} "
                        "J; allowed: at least that",
                        common_.initial_energy_j, slots, distance, needed_j));
      }
    }
  }
}

std::unique_ptr<Environment> UavFields::NewEnvironment() const {
  return std::make_unique<UavFieldsEnvironment>(*this);
}

/// Draws a start or a stop if any is allowed; otherwise returns the given one.
Cell UavFields::DrawStart(bool any, Cell given, RandomStream& stream) const {
  if (!any) {
    return given;
  }
  if (common_.map == nullptr) {
    return DrawCell(common_, stream);
  }
  const std::vector<Cell>& cells = CellsToDraw();
  return cells[stream.NextBelow(static_cast<uint32_t>(cells.size()))];
}

Scenario UavFields::Draw(uint64_t seed) const {
  RandomStream stream(seed, RandomPurpose::kEpisodeStart, 0, 0);
  Scenario field = common_;
  const int sensors = DrawInteger(ranges_.sensors, stream);
  field.coverage_radius_m = DrawNumber(ranges_.coverage_radius_m, stream);
  field.slots = DrawInteger(ranges_.slots, stream);
  field.start = DrawStart(ranges_.any_start, common_.start, stream);
  field.stop = DrawStart(ranges_.any_stop, common_.stop, stream);
  field.sensors = RandomSensors(field, sensors, seed);
  for (Sensor& sensor : field.sensors) {
    sensor = {AsInAState(sensor.x_m), AsInAState(sensor.y_m), DrawNumber(ranges_.weight, stream)};
  }
  return field;
}

void UavFields::WriteField(const Scenario& field, std::span<float> state) const {
  const UavFieldsLayout at = layout();
  std::fill(state.begin(), state.end(), 0.0f);
  state[at.slots()] = static_cast<float>(field.slots);
  state[at.coverage_radius_m()] = static_cast<float>(field.coverage_radius_m);
  state[at.start()] = static_cast<float>(field.start.column);
  state[at.start() + 1] = static_cast<float>(field.start.row);
  state[at.stop()] = static_cast<float>(field.stop.column);
  state[at.stop() + 1] = static_cast<float>(field.stop.row);
  for (size_t sensor = 0; sensor < field.sensors.size(); ++sensor) {
    state[at.sensor(sensor)] = static_cast<float>(field.sensors[sensor].x_m);
    state[at.sensor(sensor) + 1] = static_cast<float>(field.sensors[sensor].y_m);
    state[at.sensor(sensor) + 2] = static_cast<float>(field.sensors[sensor].weight);
  }
}

Scenario UavFields::FieldIn(std::span<const float> state) const {
  const UavFieldsLayout at = layout();
  FRESCO_CHECK(state.size() == at.size());
  const auto whole = [&](size_t index) { return static_cast<int>(state[index]); };
  Scenario field = common_;
  field.slots = whole(at.slots());
  field.coverage_radius_m = state[at.coverage_radius_m()];
  field.start = {whole(at.start()), whole(at.start() + 1)};
  field.stop = {whole(at.stop()), whole(at.stop() + 1)};
  field.sensors.clear();
  for (size_t sensor = 0; sensor < at.most && state[at.sensor(sensor) + 2] > 0; ++sensor) {
    field.sensors.push_back(
        {state[at.sensor(sensor)], state[at.sensor(sensor) + 1], state[at.sensor(sensor) + 2]});
  }
  return field;
}

void UavFields::Observe(std::span<const float> state, std::span<float> observation) const {
  FRESCO_CHECK(state.size() == layout().size());
  FRESCO_CHECK(observation.size() == static_cast<size_t>(observation_size()));
  const UavFieldsLayout at = layout();
  std::array<Sensor, kMaximumSensors> sensors;
  size_t count = 0;
  for (; count < at.most && state[at.sensor(count) + 2] > 0; ++count) {
    sensors[count] = {state[at.sensor(count)], state[at.sensor(count) + 1], state[at.sensor(count) + 2]};
  }
  const Cell stop = {static_cast<int>(state[at.stop()]), static_cast<int>(state[at.stop() + 1])};
  WriteSets({common_.columns, common_.rows, common_.cell_m, common_.initial_energy_j,
             static_cast<int>(state[at.slots()]), state[at.coverage_radius_m()], stop,
             std::span(sensors).first(count), common_.map.get(), map_input_ ? &*map_input_ : nullptr},
            state, observation);
}

Action UavFields::ActionAt(int index, int sensors) const {
  FRESCO_CHECK(index >= 0 && index < actions());
  const int schedule = index % schedules();
  return {static_cast<Move>(index / schedules()), schedule <= sensors ? schedule : 0};
}

std::unique_ptr<const UavWorld> UavFields::WorldOf(const Episode& episode) const {
  return std::make_unique<const UavWorld>(FieldIn(episode.state(0)), options_);
}

std::unique_ptr<const UavWorld> UavFields::WorldOf(uint64_t seed) const {
  return std::make_unique<const UavWorld>(Draw(seed), options_);
}

Episode UavFields::InItsField(const UavWorld& field, const Episode& episode) const {
  Episode flight;
  flight.seed = episode.seed;
  flight.ending = episode.ending;
  flight.rewards = episode.rewards;
  for (size_t i = 0; i <= episode.actions.size(); ++i) {
    const auto state = episode.state(i).first(static_cast<size_t>(field.state_size()));
    flight.states.insert(flight.states.end(), state.begin(), state.end());
  }
  std::vector<uint8_t> mask(static_cast<size_t>(field.actions()));
  for (size_t i = 0; i < episode.actions.size(); ++i) {
    flight.actions.push_back(
        static_cast<int16_t>(field.ActionIndex(ActionAt(episode.actions[i], field.sensors()))));
    for (int action = 0; action < field.actions(); ++action) {
      const Action in_field = field.ActionAt(action);
      const int index = static_cast<int>(in_field.move) * schedules() + in_field.schedule;
      mask[static_cast<size_t>(action)] = IsAllowedNext(episode, i, index, actions());
    }
    AppendMask(mask, flight.next_masks);
  }
  return flight;
}

Episode UavFields::FromItsField(const UavWorld& field, uint64_t seed, const Episode& flight) const {
  EpisodeRecorder recorder(*this, seed);
  for (const int16_t action : flight.actions) {
    const Action in_field = field.ActionAt(action);
    recorder.Step(static_cast<int>(in_field.move) * schedules() + in_field.schedule);
  }
  return recorder.Release();
}

std::optional<StateFormulas> UavFields::Formulate(Formulas& formulas) const {
  if (common_.map != nullptr) {
    return std::nullopt;
  }
  return FormulasOfFields(UavWorld(Largest(common_, ranges_), {options_.mask, {}}), layout(), formulas);
}

void UavFields::Judge(const Episode& episode, std::span<double> figures) const {
  const auto field = WorldOf(episode);
  field->Judge(InItsField(*field, episode), figures);
}

bool UavFields::Succeeded(const Episode& episode) const {
  return Arrived(episode);
}

EpisodeAccount UavFields::Tell(const Episode& flight) const {
  const auto field = WorldOf(flight);
  return field->Tell(InItsField(*field, flight));
}

std::vector<ReferencePolicy> UavFields::reference_policies() const {
  return WorldOf(0)->reference_policies();
}

Episode UavFields::FlyReference(const std::string& name, uint64_t seed) const {
  const auto field = WorldOf(seed);
  return FromItsField(*field, seed, field->FlyReference(name));
}

void UavFields::CheckServes(const World& other) const {
  if (const UavFields* fields = AsUavFields(other)) {
    // A field with the least and one with the most of everything.
    Scenario least = fields->common_;
    least.slots = fields->ranges_.slots.minimum;
    least.coverage_radius_m = fields->ranges_.coverage_radius_m.minimum;
    least.sensors.assign(static_cast<size_t>(fields->ranges_.sensors.minimum),
                         {0, 0, fields->ranges_.weight.minimum});
    CheckServesField(UavWorld(least, options_));
    Scenario most = Largest(fields->common_, fields->ranges_);
    most.sensors.front().weight = fields->ranges_.weight.maximum / fields->ranges_.weight.minimum;
    CheckServesField(UavWorld(most, options_));
    if ((fields->ranges_.any_start && !ranges_.any_start) ||
        (fields->ranges_.any_stop && !ranges_.any_stop)) {
      throw UsageError("start and stop of its fields are anywhere; the policy knows one start and one stop");
    }
    return;
  }
  const UavWorld* field = AsUavWorld(other);
  if (field == nullptr) {
    throw UsageError("it is no field of the UAV's world");
  }
  CheckServesField(*field);
}

void UavFields::CheckServesField(const UavWorld& field) const {
  const Scenario& scenario = field.scenario();
  const UavWorld own(Largest(common_, ranges_), options_);
  const auto check = [](bool holds, const char* what, const auto& found, const auto& expected) {
    if (!holds) {
      throw UsageError(fmt::format("{} {} is out of range; it was trained for {}", what, found, expected));
    }
  };
  const auto check_range = [&](const char* what, auto value, auto range) {
    check(value >= range.minimum && value <= range.maximum, what, value,
          range.minimum == range.maximum ? fmt::format("{}", range.minimum)
                                         : fmt::format("{} to {}", range.minimum, range.maximum));
  };
  const auto check_same = [&](const char* what, auto value, auto trained) {
    check(value == trained, what, value, trained);
  };
  const auto check_cell = [&](const char* what, Cell value, Cell trained, bool any) {
    check(any || value == trained, what, fmt::format("({}, {})", value.column, value.row),
          fmt::format("({}, {})", trained.column, trained.row));
  };
  check_range("the number of sensors (scenario.sensor)", field.sensors(), ranges_.sensors);
  check_range("scenario.coverage_radius_m", scenario.coverage_radius_m, ranges_.coverage_radius_m);
  check_range("scenario.slots", scenario.slots, ranges_.slots);
  check_same("scenario.grid.columns", scenario.columns, common_.columns);
  check_same("scenario.grid.rows", scenario.rows, common_.rows);
  check_same("scenario.grid.cell_m", scenario.cell_m, common_.cell_m);
  const auto map_text = [](const Scenario& of) {
    return of.map == nullptr ? std::vector<std::string>() : of.map->Text();
  };
  check(map_text(scenario) == map_text(common_), "scenario.map", "of other cells", "one map");
  check_same("scenario.initial_energy_j", scenario.initial_energy_j, own.scenario().initial_energy_j);
  check_same("the energy of a flown slot (scenario.rotor), in joules,", field.flying_energy_j(),
             own.flying_energy_j());
  check_same("the energy of a hovered slot (scenario.rotor), in joules,", field.hovering_energy_j(),
             own.hovering_energy_j());
  check_same("scenario.maximum_aoi", scenario.maximum_aoi.value_or(scenario.slots),
             common_.maximum_aoi.value_or(scenario.slots));
  check_cell("scenario.start", scenario.start, common_.start, ranges_.any_start);
  check_cell("scenario.stop", scenario.stop, common_.stop, ranges_.any_stop);
  // Only the ratios of weights matter, since they are divided by their sum.
  const auto [least, most] =
      std::minmax_element(scenario.sensors.begin(), scenario.sensors.end(),
                          [](const Sensor& a, const Sensor& b) { return a.weight < b.weight; });
  const double largest_ratio = ranges_.weight.maximum / ranges_.weight.minimum;
  constexpr double kLeeway = 1 + 1e-6;
  check(most->weight <= least->weight * largest_ratio * kLeeway, "the ratio of two sensors' weights",
        fmt::format("{} : {}", most->weight, least->weight), fmt::format("at most {:g}", largest_ratio));
}

std::string UavFields::GroupOf(const Episode& episode) const {
  const size_t sensors = FieldIn(episode.state(0)).sensors.size();
  return fmt::format("{} sensor{}", sensors, sensors == 1 ? "" : "s");
}

int64_t UavFields::bytes() const {
  return map_input_ ? common_.map->bytes() + map_input_->bytes() : 0;
}

int UavFields::DrawPlace(RandomStream& stream) const {
  Cell cell;
  if (common_.map == nullptr) {
    cell = DrawCell(common_, stream);
  } else {
    const std::vector<Cell>& cells = common_.map->CellsAround(common_.start);
    cell = cells[stream.NextBelow(static_cast<uint32_t>(cells.size()))];
  }
  return cell.row * common_.columns + cell.column;
}

bool UavFields::IsAt(std::span<const float> state, int place) const {
  const Cell cell = CellIn(state);
  return cell.row * common_.columns + cell.column == place;
}

ActionRange UavFields::Towards(std::span<const float> state, int place) const {
  const Cell goal = {place % common_.columns, place / common_.columns};
  const int first = static_cast<int>(MoveTowards(common_.map.get(), CellIn(state), goal)) * schedules();
  return {first, first + schedules()};
}

const UavFields* AsUavFields(const World& world) {
  return dynamic_cast<const UavFields*>(&world);
}

bool HasFlights(const World& world) {
  return AsUavWorld(world) != nullptr || AsUavFields(world) != nullptr;
}

FlightOverField OverItsField(const World& world, const Episode& episode) {
  if (const UavWorld* field = AsUavWorld(world)) {
    return {{std::shared_ptr<const void>(), field}, episode};
  }
  const UavFields* fields = AsUavFields(world);
  FRESCO_CHECK(fields != nullptr);
  std::shared_ptr<const UavWorld> field = fields->WorldOf(episode);
  Episode flight = fields->InItsField(*field, episode);
  return {std::move(field), std::move(flight)};
}

}  // namespace fresco
