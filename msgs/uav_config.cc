#include "msgs/uav_config.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.h"
#include "msgs/map_file.h"
#include "worlds/uav/obstacle_map.h"
#include "worlds/uav/physics.h"
#include "worlds/uav/uav_fields.h"

namespace fresco {
namespace {

void SetCell(proto::Cell& cell, int column, int row) {
  cell.set_column(column);
  cell.set_row(row);
}

std::vector<std::string> MapRows(const proto::Scenario& scenario) {
  return {scenario.map_row().begin(), scenario.map_row().end()};
}

/// Sets what follows from the map: columns and rows, start and stop, unless they are given.
void CompleteFromMap(proto::Scenario& scenario) {
  const std::vector<std::string> rows = MapRows(scenario);
  ObstacleMap::CheckRows(rows);
  proto::Grid& grid = *scenario.mutable_grid();
  if (!grid.has_columns()) {
    grid.set_columns(static_cast<int>(rows[0].size()));
  }
  if (!grid.has_rows()) {
    grid.set_rows(static_cast<int>(rows.size()));
  }
  const std::vector<Cell> zones = ObstacleMap::ZonesIn(rows);
  if (!zones.empty() && !scenario.has_start()) {
    SetCell(*scenario.mutable_start(), zones.front().column, zones.front().row);
  }
  if (!zones.empty() && !scenario.has_stop()) {
    SetCell(*scenario.mutable_stop(), zones.back().column, zones.back().row);
  }
}

Rotor ToRotor(const proto::Rotor& rotor) {
  return {rotor.blade_profile_power_w(),
          rotor.induced_power_w(),
          rotor.tip_speed_mps(),
          rotor.induced_velocity_mps(),
          rotor.drag_ratio(),
          rotor.air_density_kgpm3(),
          rotor.solidity(),
          rotor.disk_area_m2()};
}

Scenario ToScenario(const proto::Scenario& from) {
  Scenario scenario;
  scenario.columns = from.grid().columns();
  scenario.rows = from.grid().rows();
  scenario.cell_m = from.grid().cell_m();
  scenario.slots = from.slots();
  scenario.slot_s = from.slot_s();
  scenario.start = {from.start().column(), from.start().row()};
  scenario.stop = {from.stop().column(), from.stop().row()};
  if (!from.map_row().empty()) {
    scenario.map = std::make_shared<ObstacleMap>(MapRows(from));
    CheckPlaces(scenario);  // before sensors are drawn around the start
  }
  for (const proto::Sensor& sensor : from.sensor()) {
    scenario.sensors.push_back({sensor.x_m(), sensor.y_m(), sensor.weight()});
  }
  if (from.has_random_sensors() && !from.random_sensors().per_episode()) {
    scenario.sensors = RandomSensors(scenario, from.random_sensors().count(), from.random_sensors().seed());
  }
  scenario.radio = {from.radio().bandwidth_hz(), from.radio().update_bits(), from.radio().noise_dbm(),
                    from.radio().gain_at_1m_db(), from.radio().altitude_m()};
  scenario.coverage_radius_m = from.has_transmit_power_w()
                                   ? CoverageRadius(scenario.radio, scenario.slot_s, from.transmit_power_w())
                                   : from.coverage_radius_m();
  scenario.initial_energy_j = from.initial_energy_j();
  scenario.rotor = ToRotor(from.rotor());
  scenario.speed_mps = from.speed_mps();
  scenario.reward = {from.reward().k1(), from.reward().k2(), from.reward().k3()};
  if (from.has_maximum_aoi()) {
    scenario.maximum_aoi = from.maximum_aoi();
  }
  return scenario;
}

/// Throws UsageError if one of the limits is missing.
Interval<double> ToInterval(const std::string& path, const proto::NumberRange& range) {
  if (!range.has_minimum() || !range.has_maximum()) {
    throw UsageError(fmt::format("scenario.random_field.{}: expected a minimum and a maximum", path));
  }
  return {range.minimum(), range.maximum()};
}

Interval<int> ToWholeInterval(const std::string& path, const proto::NumberRange& range) {
  const Interval<double> limits = ToInterval(path, range);
  constexpr double kLargest = 1e9;
  for (const double limit : {limits.minimum, limits.maximum}) {
    if (!(std::abs(limit) <= kLargest && limit == std::floor(limit))) {
      throw UsageError(
          fmt::format("scenario.random_field.{}: expected whole numbers, found {}", path, limit));
    }
  }
  return {static_cast<int>(limits.minimum), static_cast<int>(limits.maximum)};
}

FieldRanges ToRanges(const proto::Scenario& from, const Scenario& scenario) {
  const proto::RandomSensors& sensors = from.random_sensors();
  const proto::RandomField& field = from.random_field();
  FieldRanges ranges;
  ranges.sensors = {sensors.has_minimum() ? sensors.minimum() : sensors.count(),
                    sensors.has_maximum() ? sensors.maximum() : sensors.count()};
  ranges.weight = field.has_weight() ? ToInterval("weight", field.weight()) : Interval<double>{1, 1};
  ranges.coverage_radius_m = field.has_coverage_radius_m()
                                 ? ToInterval("coverage_radius_m", field.coverage_radius_m())
                                 : Interval<double>{scenario.coverage_radius_m, scenario.coverage_radius_m};
  ranges.slots = field.has_slots() ? ToWholeInterval("slots", field.slots())
                                   : Interval<int>{scenario.slots, scenario.slots};
  ranges.any_start = field.any_start();
  ranges.any_stop = field.any_stop();
  return ranges;
}

/// Throws UsageError if the configuration says what only fields of an episode have, and has none of these.
void CheckOneField(const proto::Scenario& scenario) {
  const bool has_ranges = scenario.random_sensors().has_minimum() || scenario.random_sensors().has_maximum();
  if (has_ranges || scenario.has_random_field()) {
    throw UsageError(
        fmt::format("scenario.{}: only for fields that are drawn for every episode; allowed with "
                    "scenario.random_sensors.per_episode: true",
                    has_ranges ? "random_sensors: minimum, maximum" : "random_field"));
  }
}

}  // namespace

bool NamesMap(const proto::ExperimentConfig& config) {
  return config.scenario().has_map();
}

void ReadMap(proto::ExperimentConfig& config, const std::filesystem::path& folder) {
  if (!NamesMap(config)) {
    return;
  }
  proto::Scenario& scenario = *config.mutable_scenario();
  if (!scenario.map_row().empty()) {
    throw UsageError(fmt::format(
        "scenario.map (\"{}\") and scenario.map_row ({} given) contradict each other; allowed: one of "
        "the two",
        scenario.map(), scenario.map_row_size()));
  }
  std::error_code error;
  const std::filesystem::path beside = folder / scenario.map();
  std::vector<std::string> rows;
  try {
    rows =
        ReadMapFile(std::filesystem::exists(beside, error) ? beside : std::filesystem::path(scenario.map()));
  } catch (const Error& problem) {
    throw UsageError(fmt::format("scenario.map: {}", problem.what()));
  }
  scenario.clear_map();
  for (std::string& row : rows) {
    scenario.add_map_row(std::move(row));
  }
}

void CompleteScenario(proto::ExperimentConfig& config) {
  proto::Scenario& scenario = *config.mutable_scenario();
  if (scenario.has_map()) {
    throw UsageError(fmt::format(
        "scenario.map: \"{}\"; allowed only in a configuration that is read from a file, or in a setting; "
        "elsewhere scenario.map_row, the map as text",
        scenario.map()));
  }
  if (scenario.has_random_sensors() && !scenario.sensor().empty()) {
    throw UsageError(
        fmt::format("scenario.sensor ({} given) and scenario.random_sensors contradict each other; "
                    "allowed: one of the two",
                    scenario.sensor_size()));
  }
  scenario.mutable_grid();
  if (!scenario.map_row().empty()) {
    CompleteFromMap(scenario);
  }
  scenario.mutable_radio();
  scenario.mutable_rotor();
  scenario.mutable_reward();
  if (!scenario.has_start()) {
    SetCell(*scenario.mutable_start(), 10, 0);
  }
  if (!scenario.has_stop()) {
    SetCell(*scenario.mutable_stop(), 10, 19);
  }
  SetCell(*scenario.mutable_start(), scenario.start().column(), scenario.start().row());
  SetCell(*scenario.mutable_stop(), scenario.stop().column(), scenario.stop().row());
  if (scenario.sensor().empty()) {
    scenario.mutable_random_sensors();
  }
  if (scenario.coverage_case() == proto::Scenario::COVERAGE_NOT_SET) {
    scenario.set_coverage_radius_m(100);
  }
}

std::shared_ptr<const World> MakeUavWorld(const proto::ExperimentConfig& config) {
  const proto::Agent& agent = config.agent();
  const Scenario scenario = ToScenario(config.scenario());
  const UavOptions options{{agent.safe_action_mask(), agent.coverage_mask(), agent.idle_mask()},
                           {agent.sensor_geometry(), agent.has_set_network()}};
  if (config.scenario().random_sensors().per_episode()) {
    return std::make_shared<UavFields>(scenario, ToRanges(config.scenario(), scenario), options);
  }
  CheckOneField(config.scenario());
  return std::make_shared<UavWorld>(scenario, options);
}

}  // namespace fresco
