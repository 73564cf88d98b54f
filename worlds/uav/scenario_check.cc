#include "worlds/uav/scenario_check.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"

namespace fresco {
namespace {

// These bounds are wide enough for any real device, and they keep every derived number finite.
constexpr double kSmallest = 1e-6;
constexpr double kLargest = 1e6;
constexpr int kMaximumCellsASide = 1000;
// The largest product of cells and sensors. For each pair, World holds one byte and NetworkInput up to eight.
// An actor receives its scenario from the bus, so no scenario may take too much memory.
constexpr int64_t kMaximumCellsTimesSensors = 10'000'000;
constexpr int kMaximumSlots = 10000;  // so that an AoI fits int16_t
// The largest M / (B tau), bits per second and hertz. The required signal-to-noise ratio grows as two to this
// power.
constexpr double kMaximumSpectralEfficiency = 100;
// How far speed_mps * slot_s may differ from cell_m, since products of decimal fractions are rounded.
constexpr double kRelativeTolerance = 1e-9;

void CheckCell(std::string_view path, Cell cell, const Scenario& scenario) {
  RequireWithin(fmt::format("{}.column", path), cell.column, 0, scenario.columns - 1);
  RequireWithin(fmt::format("{}.row", path), cell.row, 0, scenario.rows - 1);
}

void CheckGridAndTime(const Scenario& scenario) {
  RequireWithin("scenario.grid.columns", scenario.columns, 1, kMaximumCellsASide);
  RequireWithin("scenario.grid.rows", scenario.rows, 1, kMaximumCellsASide);
  RequireWithin("scenario.grid.cell_m", scenario.cell_m, kSmallest, kLargest);
  RequireWithin("scenario.slots", scenario.slots, 2, kMaximumSlots);
  RequireWithin("scenario.slot_s", scenario.slot_s, kSmallest, kLargest);
  CheckCell("scenario.start", scenario.start, scenario);
  CheckCell("scenario.stop", scenario.stop, scenario);
}

void CheckSensors(const std::vector<Sensor>& sensors) {
  if (sensors.empty() || sensors.size() > kMaximumSensors) {
    throw UsageError(fmt::format("scenario.sensor: a count of {} is out of range; allowed: 1 to {}",
                                 sensors.size(), kMaximumSensors));
  }
  double total_weight = 0;
  for (size_t index = 0; index < sensors.size(); ++index) {
    const std::string path = fmt::format("scenario.sensor[{}]", index);
    RequireWithin(path + ".x_m", sensors[index].x_m, -kLargest, kLargest);
    RequireWithin(path + ".y_m", sensors[index].y_m, -kLargest, kLargest);
    RequireWithin(path + ".weight", sensors[index].weight, 0, kLargest);
    total_weight += sensors[index].weight;
  }
  if (total_weight < kSmallest) {
    throw UsageError(fmt::format("scenario.sensor: the weights sum to {}; allowed: a sum of at least {}",
                                 total_weight, kSmallest));
  }
}

void CheckSize(const Scenario& scenario) {
  const auto sensors = static_cast<int64_t>(scenario.sensors.size());
  if (int64_t{scenario.columns} * scenario.rows * sensors > kMaximumCellsTimesSensors) {
    throw UsageError(
        fmt::format("scenario.grid: {} x {} cells and {} sensors are too many; allowed: a product of "
                    "at most {}",
                    scenario.columns, scenario.rows, sensors, kMaximumCellsTimesSensors));
  }
}

void CheckRotor(const Rotor& rotor) {
  RequireWithin("scenario.rotor.blade_profile_power_w", rotor.blade_profile_power_w, 0, kLargest);
  RequireWithin("scenario.rotor.induced_power_w", rotor.induced_power_w, 0, kLargest);
  RequireWithin("scenario.rotor.tip_speed_mps", rotor.tip_speed_mps, kSmallest, kLargest);
  RequireWithin("scenario.rotor.induced_velocity_mps", rotor.induced_velocity_mps, kSmallest, kLargest);
  RequireWithin("scenario.rotor.drag_ratio", rotor.drag_ratio, 0, kLargest);
  RequireWithin("scenario.rotor.air_density_kgpm3", rotor.air_density_kgpm3, 0, kLargest);
  RequireWithin("scenario.rotor.solidity", rotor.solidity, 0, kLargest);
  RequireWithin("scenario.rotor.disk_area_m2", rotor.disk_area_m2, 0, kLargest);
}

void CheckReward(const Reward& reward) {
  RequireWithin("scenario.reward.k1", reward.k1, 0, kLargest);
  RequireWithin("scenario.reward.k2", reward.k2, 0, kLargest);
  RequireWithin("scenario.reward.k3", reward.k3, 0, kLargest);
}

// "In each time slot, the UAV could hover over a certain grid or fly across one grid at a constant
// speed V" (section II).
void CheckSpeed(const Scenario& scenario) {
  RequireWithin("scenario.speed_mps", scenario.speed_mps, kSmallest, kLargest);
  const double flown_m = scenario.speed_mps * scenario.slot_s;
  if (std::abs(flown_m - scenario.cell_m) > kRelativeTolerance * scenario.cell_m) {
    throw UsageError(
        fmt::format("scenario.speed_mps: {} for scenario.slot_s: {} makes {} m a slot, but the UAV flies one "
                    "cell a slot and scenario.grid.cell_m is {}; allowed: speed_mps * slot_s = cell_m",
                    scenario.speed_mps, scenario.slot_s, flown_m, scenario.cell_m));
  }
}

void CheckStopIsReachableInTime(const Scenario& scenario) {
  const int distance = std::abs(scenario.start.column - scenario.stop.column) +
                       std::abs(scenario.start.row - scenario.stop.row);
  if (distance > scenario.slots - 1) {
    throw UsageError(fmt::format(
        "scenario.slots: {} is out of range: scenario.stop is {} moves from scenario.start and there is time "
        "for {}, {} too few; allowed: {} to {}",
        scenario.slots, distance, scenario.slots - 1, distance - scenario.slots + 1, distance + 1,
        kMaximumSlots));
  }
}

}  // namespace

void RequireWithin(std::string_view path, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw UsageError(fmt::format("{}: {} is out of range; allowed: {} to {}", path, value, low, high));
  }
}

void CheckRadio(const Radio& radio, double slot_s) {
  RequireWithin("scenario.slot_s", slot_s, kSmallest, kLargest);
  RequireWithin("scenario.radio.bandwidth_hz", radio.bandwidth_hz, 1, 1e12);
  RequireWithin("scenario.radio.update_bits", radio.update_bits, 1, 1e15);
  RequireWithin("scenario.radio.noise_dbm", radio.noise_dbm, -300, 100);
  RequireWithin("scenario.radio.gain_at_1m_db", radio.gain_at_1m_db, -300, 100);
  RequireWithin("scenario.radio.altitude_m", radio.altitude_m, 0, kLargest);
  const double efficiency = radio.update_bits / (radio.bandwidth_hz * slot_s);
  if (efficiency > kMaximumSpectralEfficiency) {
    throw UsageError(fmt::format(
        "scenario.radio.update_bits: {} in scenario.slot_s: {} over scenario.radio.bandwidth_hz: {} makes {} "
        "bit/s/Hz; allowed: at most {}",
        radio.update_bits, slot_s, radio.bandwidth_hz, efficiency, kMaximumSpectralEfficiency));
  }
}

void CheckScenario(const Scenario& scenario) {
  CheckGridAndTime(scenario);
  CheckSensors(scenario.sensors);
  CheckSize(scenario);
  RequireWithin("scenario.coverage_radius_m", scenario.coverage_radius_m, 0, kLargest);
  RequireWithin("scenario.initial_energy_j", scenario.initial_energy_j, kSmallest, kMaximumEnergyJ);
  CheckRadio(scenario.radio, scenario.slot_s);
  CheckRotor(scenario.rotor);
  CheckSpeed(scenario);
  CheckReward(scenario.reward);
  if (scenario.maximum_aoi) {
    RequireWithin("scenario.maximum_aoi", *scenario.maximum_aoi, 1, kMaximumSlots);
  }
  CheckStopIsReachableInTime(scenario);
}

}  // namespace fresco
