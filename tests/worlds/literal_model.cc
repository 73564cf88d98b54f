#include "tests/worlds/literal_model.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include "worlds/uav/obstacle_map.h"

namespace fresco {
namespace {

const std::map<std::string, std::pair<int, int>> kSteps = {
    {"north", {0, 1}}, {"south", {0, -1}}, {"east", {1, 0}}, {"west", {-1, 0}}, {"hover", {0, 0}}};

/// '.' without a map.
char KindLiterally(const Scenario& scenario, Cell cell) {
  return scenario.map == nullptr ? '.' : static_cast<char>(scenario.map->KindOf(cell));
}

/// Whether the inside of a cell has points on the line; all in parts of a cell.
bool Cuts(int64_t x, int64_t y, int64_t end_x, int64_t end_y, int64_t west, int64_t south, int64_t side) {
  if (std::max(x, end_x) <= west || std::min(x, end_x) >= west + side || std::max(y, end_y) <= south ||
      std::min(y, end_y) >= south + side) {
    return false;
  }
  if (x == end_x && y == end_y) {
    return true;
  }
  bool left = false;
  bool right = false;
  for (const auto& [corner_x, corner_y] :
       {std::pair(west, south), {west + side, south}, {west, south + side}, {west + side, south + side}}) {
    const int64_t turn = (end_x - x) * (corner_y - y) - (end_y - y) * (corner_x - x);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return left && right;
}

Cell Moved(const Scenario& scenario, Cell cell, const std::string& move) {
  const auto [columns, rows] = kSteps.at(move);
  const Cell next{cell.column + columns, cell.row + rows};
  return MayFlyLiterally(scenario, next) ? next : cell;
}

bool InCoverage(const Scenario& scenario, Cell cell, const Sensor& sensor) {
  const double x = cell.column * scenario.cell_m - sensor.x_m;
  const double y = cell.row * scenario.cell_m - sensor.y_m;
  return std::sqrt(x * x + y * y) <= scenario.coverage_radius_m &&
         HasLineOfSightLiterally(scenario, cell, sensor);
}

// t - U_n(t): slots since the last one in which sensor n was scheduled under coverage, slot 0 at first.
int LiteralAoi(const Scenario& scenario, const std::vector<Cell>& path, const std::vector<Action>& actions,
               int sensor) {
  int last = 0;
  for (size_t i = 0; i < actions.size(); ++i) {
    if (actions[i].schedule == sensor + 1 &&
        InCoverage(scenario, path[i], scenario.sensors[static_cast<size_t>(sensor)])) {
      last = static_cast<int>(i) + 1;
    }
  }
  const int aoi = static_cast<int>(actions.size()) + 1 - last;
  return scenario.maximum_aoi ? std::min(aoi, *scenario.maximum_aoi) : aoi;
}

double LiteralReward(const Scenario& scenario, const LiteralState& state) {
  double weights = 0;
  double weighted_aoi = 0;
  for (size_t n = 0; n < state.aoi.size(); ++n) {
    weights += scenario.sensors[n].weight;
    weighted_aoi += scenario.sensors[n].weight * state.aoi[n];
  }
  return -weighted_aoi / weights / scenario.slots - (state.phi < 0 ? scenario.reward.k1 : 0) -
         (state.delta_j < 0 ? scenario.reward.k2 : 0) + (state.outcome == "arrived" ? scenario.reward.k3 : 0);
}

}  // namespace

bool MayFlyLiterally(const Scenario& scenario, Cell cell) {
  const bool outside =
      cell.column < 0 || cell.row < 0 || cell.column >= scenario.columns || cell.row >= scenario.rows;
  return !outside && KindLiterally(scenario, cell) != 'N' && KindLiterally(scenario, cell) != 'B';
}

int LiteralDistance(const Scenario& scenario, Cell from, Cell to) {
  if (scenario.map == nullptr) {
    return std::abs(from.column - to.column) + std::abs(from.row - to.row);
  }
  constexpr int kFar = 1'000'000;
  std::map<std::pair<int, int>, int> distances;
  for (int column = 0; column < scenario.columns; ++column) {
    for (int row = 0; row < scenario.rows; ++row) {
      distances[{column, row}] = Cell{column, row} == from && MayFlyLiterally(scenario, from) ? 0 : kFar;
    }
  }
  for (bool falling = true; falling;) {
    falling = false;
    for (auto& [place, distance] : distances) {
      for (const auto& [move, step] : kSteps) {
        const std::pair next = {place.first + step.first, place.second + step.second};
        if (distance < kFar && MayFlyLiterally(scenario, {next.first, next.second}) &&
            distances[next] > distance + 1) {
          distances[next] = distance + 1;
          falling = true;
        }
      }
    }
  }
  return distances[{to.column, to.row}];
}

bool HasLineOfSightLiterally(const Scenario& scenario, Cell cell, const Sensor& sensor) {
  constexpr int64_t kSide = 65536;
  const auto rounded = [&](double position_m) {
    return static_cast<int64_t>(std::floor(position_m / scenario.cell_m * kSide + 0.5));
  };
  for (int column = 0; scenario.map != nullptr && column < scenario.columns; ++column) {
    for (int row = 0; row < scenario.rows; ++row) {
      const char kind = KindLiterally(scenario, {column, row});
      const double x = static_cast<double>(rounded(sensor.x_m)) / kSide;
      const double y = static_cast<double>(rounded(sensor.y_m)) / kSide;
      // On an edge between two cells, a sensor stands in the western or southern one; on the map's edge, in
      // the only one.
      const bool stands_here = (x > column - 0.5 || column == 0) && x <= column + 0.5 &&
                               (y > row - 0.5 || row == 0) && y <= row + 0.5;
      if ((kind == 'R' || kind == 'B') && !stands_here &&
          Cuts(cell.column * kSide, cell.row * kSide, rounded(sensor.x_m), rounded(sensor.y_m),
               column * kSide - kSide / 2, row * kSide - kSide / 2, kSide)) {
        return false;
      }
    }
  }
  return true;
}

double LiteralPower(const Rotor& rotor, double speed_mps) {
  const double x = std::pow(speed_mps / rotor.induced_velocity_mps, 2) / 2;
  // For large x, sqrt(1 + x^2) - x is 1 / (2 x), and its root v0 / V.
  const double induced =
      x > 1e3 ? rotor.induced_velocity_mps / speed_mps : std::sqrt(std::sqrt(1 + x * x) - x);
  return rotor.blade_profile_power_w * (1 + 3 * std::pow(speed_mps / rotor.tip_speed_mps, 2)) +
         rotor.induced_power_w * induced +
         rotor.drag_ratio * rotor.air_density_kgpm3 * rotor.solidity * rotor.disk_area_m2 *
             std::pow(speed_mps, 3) / 2;
}

LiteralState SimulateLiterally(const Scenario& scenario, const std::vector<Action>& actions) {
  const double flying_j = LiteralPower(scenario.rotor, scenario.speed_mps) * scenario.slot_s;
  const double hovering_j = LiteralPower(scenario.rotor, 0) * scenario.slot_s;
  std::vector<Cell> path = {scenario.start};
  LiteralState state;
  state.remaining_j = scenario.initial_energy_j;
  for (const Action& action : actions) {
    path.push_back(Moved(scenario, path.back(), MoveName(action.move)));
    state.remaining_j -= path.back() == path[path.size() - 2] ? hovering_j : flying_j;
  }
  state.cell = path.back();
  for (int n = 0; n < static_cast<int>(scenario.sensors.size()); ++n) {
    state.aoi.push_back(LiteralAoi(scenario, path, actions, n));
  }
  const int left = scenario.slots - static_cast<int>(path.size());
  const int distance = LiteralDistance(scenario, state.cell, scenario.stop);
  state.phi = left - distance;
  const bool all_flown = flying_j <= hovering_j || state.phi < 0;
  state.delta_j =
      state.remaining_j - (all_flown ? left * flying_j : distance * flying_j + state.phi * hovering_j);
  state.outcome = state.phi < 0       ? "out of time"
                  : state.delta_j < 0 ? "out of energy"
                  : left == 0         ? "arrived"
                                      : "flying";
  state.reward = LiteralReward(scenario, state);
  return state;
}

bool SomeFlightReachesStop(const Scenario& scenario, Cell cell, int slots_left, double remaining_j) {
  if (slots_left < 0) {
    return false;
  }
  using PlaceAndHovers = std::pair<std::pair<int, int>, int>;  // (column, row), hovers
  std::set<PlaceAndHovers> situations = {{{cell.column, cell.row}, 0}};
  for (int slot = 0; slot < slots_left; ++slot) {
    std::set<PlaceAndHovers> next;
    for (const auto& [place, hovers] : situations) {
      for (const auto& [move, step] : kSteps) {
        const Cell from{place.first, place.second};
        const Cell to = Moved(scenario, from, move);
        next.insert({{to.column, to.row}, hovers + (to == from ? 1 : 0)});
      }
    }
    situations = std::move(next);
  }
  const double flying_j = LiteralPower(scenario.rotor, scenario.speed_mps) * scenario.slot_s;
  const double hovering_j = LiteralPower(scenario.rotor, 0) * scenario.slot_s;
  for (const auto& [place, hovers] : situations) {
    const double used_j = hovers * hovering_j + (slots_left - hovers) * flying_j;
    if (Cell{place.first, place.second} == scenario.stop && used_j <= remaining_j + 1e-6) {
      return true;
    }
  }
  return false;
}

}  // namespace fresco
