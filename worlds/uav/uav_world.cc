#include "worlds/uav/uav_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "worlds/uav/aoi_figures.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/flight.h"
#include "worlds/uav/physics.h"
#include "worlds/uav/uav_environment.h"
#include "worlds/uav/uav_formulas.h"

namespace fresco {
namespace {

constexpr char kAoiPolicy[] = "aoi";
constexpr char kDistancePolicy[] = "distance";
// The largest product of cells and sensors. For each pair, UavWorld holds one byte and its NetworkInput up to
// eight. An actor receives its scenario from the bus, so no scenario may take too much memory.
constexpr int64_t kMaximumCellsTimesSensors = 10'000'000;
// The largest energy of a slot, joules. It keeps energy margins finite as the floats that messages carry.
constexpr double kMaximumEnergyJ = 1e12;
// How far speed_mps * slot_s may differ from cell_m, since products of decimal fractions are rounded.
constexpr double kRelativeTolerance = 1e-9;

void RequireWithin(const std::string& path, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw UsageError(fmt::format("{}: {} is out of range; allowed: {} to {}", path, value, low, high));
  }
}

void CheckCell(const std::string& path, Cell cell, const Scenario& scenario) {
  RequireWithin(path + ".column", cell.column, 0, scenario.columns - 1);
  RequireWithin(path + ".row", cell.row, 0, scenario.rows - 1);
}

void CheckSensors(const std::vector<Sensor>& sensors) {
  constexpr double kSmallestSum = 1e-6;
  if (sensors.empty() || sensors.size() > kMaximumSensors) {
    throw UsageError(fmt::format("scenario.sensor: a count of {} is out of range; allowed: 1 to {}",
                                 sensors.size(), kMaximumSensors));
  }
  double total_weight = 0;
  for (const Sensor& sensor : sensors) {
    total_weight += sensor.weight;
  }
  if (!(total_weight >= kSmallestSum)) {
    throw UsageError(fmt::format("scenario.sensor: the weights sum to {}; allowed: a sum of at least {}",
                                 total_weight, kSmallestSum));
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

// "In each time slot, the UAV could hover over a certain grid or fly across one grid at a constant
// speed V" (section II).
void CheckSpeed(const Scenario& scenario) {
  const double flown_m = scenario.speed_mps * scenario.slot_s;
  if (std::abs(flown_m - scenario.cell_m) > kRelativeTolerance * scenario.cell_m) {
    throw UsageError(
        fmt::format("scenario.speed_mps: {} for scenario.slot_s: {} makes {} m a slot, but the UAV flies one "
                    "cell a slot and scenario.grid.cell_m is {}; allowed: speed_mps * slot_s = cell_m",
                    scenario.speed_mps, scenario.slot_s, flown_m, scenario.cell_m));
  }
}

void CheckMayFly(const std::string& path, Cell cell, const ObstacleMap& map) {
  if (!map.MayFly(cell)) {
    throw UsageError(
        fmt::format("{}: column {}, row {} is a cell of scenario.map_row ('{}') that can't be flown over; "
                    "allowed: '{}', '{}' "
                    "or '{}'",
                    path, cell.column, cell.row, static_cast<char>(map.KindOf(cell)),
                    static_cast<char>(CellKind::kStartAndLanding), static_cast<char>(CellKind::kFree),
                    static_cast<char>(CellKind::kBlocksRadio)));
  }
}

// Half a cell beyond the centres of the outermost cells belongs to the map.
void CheckIsOnMap(const Sensor& sensor, size_t number, const Scenario& scenario) {
  const std::string path = fmt::format("scenario.sensor[{}]", number);
  RequireWithin(path + ".x_m (with scenario.map_row)", sensor.x_m, -0.5 * scenario.cell_m,
                (scenario.columns - 0.5) * scenario.cell_m);
  RequireWithin(path + ".y_m (with scenario.map_row)", sensor.y_m, -0.5 * scenario.cell_m,
                (scenario.rows - 0.5) * scenario.cell_m);
}

void CheckMap(const Scenario& scenario) {
  const ObstacleMap& map = *scenario.map;
  if (map.columns() != scenario.columns || map.rows() != scenario.rows) {
    throw UsageError(
        fmt::format("scenario.grid: {} columns and {} rows contradict scenario.map_row, which has {} and {}; "
                    "allowed: omitted, or "
                    "those of the map",
                    scenario.columns, scenario.rows, map.columns(), map.rows()));
  }
  CheckMayFly("scenario.start", scenario.start, map);
  CheckMayFly("scenario.stop", scenario.stop, map);
  if (map.Distance(scenario.start, scenario.stop) == ObstacleMap::kCutOff) {
    throw UsageError(
        fmt::format("scenario.stop: column {}, row {} is cut off from scenario.start (column {}, row {}) by "
                    "the obstacles of "
                    "scenario.map_row; allowed: one of the {} cells that flights from the start lead to",
                    scenario.stop.column, scenario.stop.row, scenario.start.column, scenario.start.row,
                    map.CellsAround(scenario.start).size()));
  }
}

void CheckStopIsReachableInTime(const Scenario& scenario) {
  const int distance = scenario.map != nullptr ? scenario.map->Distance(scenario.start, scenario.stop)
                                               : std::abs(scenario.start.column - scenario.stop.column) +
                                                     std::abs(scenario.start.row - scenario.stop.row);
  if (distance > scenario.slots - 1) {
    throw UsageError(fmt::format(
        "scenario.slots: {} is out of range: scenario.stop is {} moves from scenario.start and there is time "
        "for {}, {} too few; allowed: at least {}",
        scenario.slots, distance, scenario.slots - 1, distance - scenario.slots + 1, distance + 1));
  }
}

const Scenario& Checked(const Scenario& scenario) {
  CheckPlaces(scenario);
  CheckSensors(scenario.sensors);
  CheckSize(scenario);
  for (size_t i = 0; scenario.map != nullptr && i < scenario.sensors.size(); ++i) {
    CheckIsOnMap(scenario.sensors[i], i, scenario);
  }
  CheckRadio(scenario.radio, scenario.slot_s);
  CheckSpeed(scenario);
  CheckStopIsReachableInTime(scenario);
  return scenario;
}

std::vector<Quantity> StateFields(size_t sensors) {
  std::vector<Quantity> fields = {
      {"column", "cells"}, {"row", "cells"}, {"time_margin", "slots"}, {"energy_margin_j", "J"}};
  for (size_t sensor = 1; sensor <= sensors; ++sensor) {
    fields.push_back({fmt::format("aoi_{}", sensor), "slots"});
  }
  return fields;
}

std::vector<std::string> ActionNames(size_t sensors) {
  std::vector<std::string> names;
  for (int move = 0; move < kMoves; ++move) {
    for (size_t schedule = 0; schedule <= sensors; ++schedule) {
      const char* name = MoveName(static_cast<Move>(move));
      names.push_back(schedule == 0 ? name : fmt::format("{}, sensor {}", name, schedule));
    }
  }
  return names;
}

WorldDescription Describe(const Scenario& scenario, const UavOptions& options) {
  const size_t sensors = scenario.sensors.size();
  WorldDescription description;
  description.name = "uav";
  description.state = StateFields(sensors);
  description.actions = ActionNames(sensors);
  description.observation_size = NetworkInput::Size(static_cast<int>(sensors), options.network_input);
  description.longest_episode = scenario.slots - 1;
  description.random = false;
  description.chance = false;
  description.figures = {{"average_aoi", "slots"}, {"total_aoi", "slots"}, {"sum_aoi", "slots"}};
  description.less_is_better = true;
  description.success = "arrived";
  description.copies = true;
  description.preferences.assign(description.state.size(), Preference::kOnlyEqual);
  description.preferences[kEnergyMarginField] = Preference::kMore;
  std::fill_n(description.preferences.begin() + kAoiField, sensors, Preference::kLess);
  if (options.network_input.sets) {
    description.sets = SetsOf(static_cast<int>(sensors));
  }
  return description;
}

double RoundTo(double value, double quantum) {
  return std::nearbyint(value / quantum) * quantum;
}

}  // namespace

const char* MoveName(Move move) {
  switch (move) {
    case Move::kNorth:
      return "north";
    case Move::kSouth:
      return "south";
    case Move::kEast:
      return "east";
    case Move::kWest:
      return "west";
    case Move::kHover:
      return "hover";
  }
  CheckFailed(__FILE_NAME__, __LINE__, "a move of 0 to 4");
}

void CheckPlaces(const Scenario& scenario) {
  CheckCell("scenario.start", scenario.start, scenario);
  CheckCell("scenario.stop", scenario.stop, scenario);
  if (scenario.map != nullptr) {
    CheckMap(scenario);
  }
}

UavWorld::UavWorld(Scenario scenario, UavOptions options)
    : World(Describe(Checked(scenario), options)), scenario_(std::move(scenario)), options_(options) {
  if (map() != nullptr) {
    to_stop_ = map()->DistancesTo(scenario_.stop).data();
  }
  for (int move = 0; move < kMoves; ++move) {
    for (int schedule = 0; schedule <= sensors(); ++schedule) {
      actions_.push_back({static_cast<Move>(move), schedule});
    }
  }
  DeriveEnergies();
  DeriveTheta();
  DeriveCoverage();
  network_input_.emplace(*this, options.network_input);
  const int moves = longest_episode();
  const int distance = DistanceToStop(scenario_.start);
  if (!CanReachStop(*this, distance, moves, scenario_.initial_energy_j)) {
    const double needed_j = CompletionEnergy(*this, distance, moves);
    throw UsageError(fmt::format(
        "scenario.initial_energy_j: {} is out of range: the cheapest flight from scenario.start to "
        "scenario.stop in {} slots takes {:.6g} J, {:.6g} J more; allowed: at least that",
        scenario_.initial_energy_j, scenario_.slots, needed_j, needed_j - scenario_.initial_energy_j));
  }
}

// Rounds the energies to multiples of a power of two. It is so large that sums over a whole flight are exact
// in double, and so small (about 1e-15 of the total) that the rounding has no other effect.
void UavWorld::DeriveEnergies() {
  const double flying_j = PropulsionPower(scenario_.rotor, scenario_.speed_mps) * scenario_.slot_s;
  const double hovering_j = PropulsionPower(scenario_.rotor, 0) * scenario_.slot_s;
  RequireWithin("scenario.rotor: the energy in joules of a slot's flight", flying_j, 0, kMaximumEnergyJ);
  RequireWithin("scenario.rotor: the energy in joules of a slot's hover", hovering_j, 0, kMaximumEnergyJ);
  const double largest_j =
      std::max(scenario_.initial_energy_j, scenario_.slots * std::max(flying_j, hovering_j));
  constexpr int kSignificandBits = 53;
  const double quantum = std::ldexp(1.0, std::ilogb(largest_j) + 2 - kSignificandBits);
  flying_energy_j_ = RoundTo(flying_j, quantum);
  hovering_energy_j_ = RoundTo(hovering_j, quantum);
  const bool has_neighbour = std::any_of(kMoveSteps.begin(), kMoveSteps.end() - 1, [&](Cell step) {
    return MayFly({scenario_.stop.column + step.column, scenario_.stop.row + step.row});
  });
  flies_spare_slots_ = flying_energy_j_ < hovering_energy_j_ && has_neighbour;
  scenario_.initial_energy_j = RoundTo(scenario_.initial_energy_j, quantum);
}

void UavWorld::DeriveTheta() {
  double total_weight = 0;
  for (const Sensor& sensor : scenario_.sensors) {
    total_weight += sensor.weight;
  }
  for (const Sensor& sensor : scenario_.sensors) {
    theta_.push_back(sensor.weight / total_weight);
  }
}

void UavWorld::DeriveCoverage() {
  coverage_.reserve(static_cast<size_t>(scenario_.columns) * scenario_.rows * scenario_.sensors.size());
  for (int row = 0; row < scenario_.rows; ++row) {
    for (int column = 0; column < scenario_.columns; ++column) {
      const Cell cell = {column, row};
      for (const Sensor& sensor : scenario_.sensors) {
        coverage_.push_back(
            IsWithin(scenario_.coverage_radius_m, HorizontalDistance(cell, scenario_.cell_m, sensor)) &&
            (map() == nullptr ||
             (map()->MayFly(cell) && map()->HasLineOfSight(cell, sensor, scenario_.cell_m))));
      }
    }
  }
}

int64_t UavWorld::bytes() const {
  const auto size = [](const auto& vector) {
    return static_cast<int64_t>(vector.size() * sizeof(vector[0]));
  };
  return size(scenario_.sensors) + size(theta_) + size(coverage_) + network_input_->bytes() +
         (map() != nullptr ? map()->bytes() : 0);
}

std::unique_ptr<Environment> UavWorld::NewEnvironment() const {
  return std::make_unique<UavEnvironment>(*this);
}

void UavWorld::Observe(std::span<const float> state, std::span<float> observation) const {
  network_input_->Write(state, observation);
}

std::optional<StateFormulas> UavWorld::Formulate(Formulas& formulas) const {
  return FormulasOfField(*this, formulas);
}

void UavWorld::Judge(const Episode& episode, std::span<double> figures) const {
  const AoiFigures aoi = Figures(*this, episode);
  figures[static_cast<size_t>(UavFigure::kAverageAoi)] = aoi.average_aoi;
  figures[static_cast<size_t>(UavFigure::kTotalAoi)] = static_cast<double>(aoi.total_aoi);
  figures[static_cast<size_t>(UavFigure::kSumAoi)] = aoi.sum_aoi;
}

bool UavWorld::Succeeded(const Episode& episode) const {
  return OutcomeOf(episode) == Outcome::kArrived;
}

EpisodeAccount UavWorld::Tell(const Episode& flight) const {
  const AoiFigures aoi = Figures(*this, flight);
  const std::string outcome = OutcomeName(OutcomeOf(flight));
  const double residual_j = ResidualEnergy(*this, flight);
  EpisodeAccount account;
  account.sentence = fmt::format("{}; average AoI {:.3f} slots, total AoI {}, {:.0f} J left", outcome,
                                 aoi.average_aoi, aoi.total_aoi, residual_j);
  account.facts = {{description().success, Arrived(flight)},
                   {"outcome", outcome},
                   {"slots", int64_t{flight.transitions() + 1}},
                   {"total_aoi", aoi.total_aoi},
                   {"average_aoi", aoi.average_aoi},
                   {"sum_aoi", aoi.sum_aoi},
                   {"residual_energy_j", residual_j}};
  account.steps_name = "flight";
  account.columns = {"slot", "column", "row", "move", "scheduled", "aoi"};
  for (size_t i = 0; i <= flight.actions.size(); ++i) {
    const UavState state = StateIn(flight, i);
    const Action action = ActionIn(*this, flight, i);
    account.steps.push_back({int64_t{state.slot}, int64_t{state.cell.column}, int64_t{state.cell.row},
                             MoveName(action.move), int64_t{action.schedule},
                             std::vector<int64_t>(state.aoi.begin(), state.aoi.end())});
  }
  return account;
}

std::vector<ReferencePolicy> UavWorld::reference_policies() const {
  return {{kAoiPolicy, "AoI-based"}, {kDistancePolicy, "distance-based"}};
}

Episode UavWorld::FlyReference(const std::string& name, uint64_t /*seed*/) const {
  FRESCO_CHECK(name == kAoiPolicy || name == kDistancePolicy);
  return FlyBaseline(*this, name == kAoiPolicy ? BaselineKind::kAoi : BaselineKind::kDistance);
}

int UavWorld::DrawPlace(RandomStream& stream) const {
  if (map() != nullptr) {
    const std::vector<Cell>& cells = map()->CellsAround(scenario_.start);
    return CellIndex(cells[stream.NextBelow(static_cast<uint32_t>(cells.size()))]);
  }
  const auto column = static_cast<int>(stream.NextBelow(static_cast<uint32_t>(scenario_.columns)));
  const auto row = static_cast<int>(stream.NextBelow(static_cast<uint32_t>(scenario_.rows)));
  return CellIndex({column, row});
}

bool UavWorld::IsAt(std::span<const float> state, int place) const {
  return CellIndex(CellIn(state)) == place;
}

ActionRange UavWorld::Towards(std::span<const float> state, int place) const {
  const Cell goal = {place % scenario_.columns, place / scenario_.columns};
  const int first = ActionIndex({MoveTowards(map(), CellIn(state), goal), 0});
  return {first, first + sensors() + 1};
}

const UavWorld* AsUavWorld(const World& world) {
  return dynamic_cast<const UavWorld*>(&world);
}

const UavWorld& RequireUavWorld(const World& world, const std::string& what) {
  const UavWorld* uav = AsUavWorld(world);
  if (uav == nullptr) {
    throw UsageError(fmt::format("{}: only the UAV's world (scenario) has this; the world is {}", what,
                                 world.description().name));
  }
  return *uav;
}

Move MoveTowards(Cell from, Cell to) {
  const int columns = to.column - from.column;
  const int rows = to.row - from.row;
  if (columns == 0 && rows == 0) {
    return Move::kHover;
  }
  if (std::abs(columns) >= std::abs(rows)) {
    return columns > 0 ? Move::kEast : Move::kWest;
  }
  return rows > 0 ? Move::kNorth : Move::kSouth;
}

Move MoveTowards(const ObstacleMap* map, Cell from, Cell to) {
  const Move open = MoveTowards(from, to);
  if (map == nullptr || open == Move::kHover) {
    return open;
  }
  const int distance = map->Distance(to, from);
  if (distance == ObstacleMap::kCutOff) {
    return Move::kHover;
  }
  for (const Move move : {open, Move::kNorth, Move::kSouth, Move::kEast, Move::kWest}) {
    const Cell step = kMoveSteps[static_cast<size_t>(move)];
    const Cell next = {from.column + step.column, from.row + step.row};
    if (map->MayFly(next) && map->Distance(to, next) < distance) {
      return move;
    }
  }
  return Move::kHover;
}

}  // namespace fresco
