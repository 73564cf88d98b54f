// Whole flights as text, as a reader would want to see them (tests/worlds/golden_text.h).
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "tests/worlds/golden_text.h"
#include "tests/worlds/table_one.h"
#include "tests/worlds/test_scenarios.h"
#include "worlds/uav/uav_environment.h"

namespace fresco {
namespace {

/// Flies from cell to cell, waits over each, then goes to the stop. Schedules the covered sensor of the
/// largest AoI, the first of several. If it obeys the mask and may not move as it likes, it flies towards the
/// stop.
struct Pilot {
  std::vector<Cell> waypoints;
  int wait_slots = 0;
  bool obeys_mask = true;
};

template <class... Values>
std::string Format(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

class EpisodeText {
 public:
  EpisodeText(const Scenario& scenario, Pilot pilot)
      : world_(scenario), environment_(world_), pilot_(std::move(pilot)) {}

  std::string Fly() {
    WriteScenario();
    text_ += "slot  cell      phi    Delta_J   energy_J  safe   covered  AoI          action     reward\n";
    while (environment_.outcome() == Outcome::kFlying) {
      WriteState();
      const Action action = Choose();
      const StepResult result = environment_.Step(action);
      text_ += Format("%s %d", MoveName(action.move), action.schedule);
      text_ +=
          Format("%*.6f\n", 17 - static_cast<int>(std::string(MoveName(action.move)).size()), result.reward);
    }
    WriteState();
    return text_ + OutcomeName(environment_.outcome()) + "\n";
  }

 private:
  void WriteScenario() {
    const Scenario& s = world_.scenario();
    text_ =
        Format("grid %d x %d, cells of %g m, %d slots of %g s, from (%d, %d) to (%d, %d)\n", s.columns,
               s.rows, s.cell_m, s.slots, s.slot_s, s.start.column, s.start.row, s.stop.column, s.stop.row);
    text_ += Format("energy %.2f J, a slot of flight %.4f J, of a hover %.4f J, k1 %g, k2 %g, k3 %g\n",
                    s.initial_energy_j, world_.flying_energy_j(), world_.hovering_energy_j(), s.reward.k1,
                    s.reward.k2, s.reward.k3);
    text_ += s.maximum_aoi ? Format("AoI at most %d\n", *s.maximum_aoi) : "";
    for (const std::string& row : s.map != nullptr ? s.map->Text() : std::vector<std::string>()) {
      text_ += "map " + row + "\n";
    }
    for (size_t i = 0; i < s.sensors.size(); ++i) {
      text_ += Format("sensor %d at %g m, %g m, theta %.6f, covered within %g m\n", static_cast<int>(i) + 1,
                      s.sensors[i].x_m, s.sensors[i].y_m, world_.theta()[i], s.coverage_radius_m);
    }
  }

  bool Allows(MaskOptions options, Action action) const {
    std::vector<uint8_t> mask(static_cast<size_t>(world_.actions()));
    environment_.WriteMask(options, mask);
    return mask[static_cast<size_t>(world_.ActionIndex(action))] != 0;
  }
  bool MaySchedule(int sensor) const {
    return Allows({.safe_actions = false, .coverage = true}, {Move::kHover, sensor});
  }
  bool MayMove(Move move) const { return Allows({.safe_actions = true, .coverage = false}, {move, 0}); }

  /// The part of a line before the action. N, S, E, W, H: the moves that the mask of safe actions allows.
  void WriteState() {
    const UavState& state = environment_.state();
    std::string moves, covered, aoi;
    const bool flying = environment_.outcome() == Outcome::kFlying;
    for (int move = 0; move < kMoves; ++move) {
      moves += flying && MayMove(static_cast<Move>(move)) ? "NSEWH"[move] : '.';
    }
    for (int sensor = 1; sensor <= world_.sensors(); ++sensor) {
      covered += flying && MaySchedule(sensor) ? Format("%d", sensor) : ".";
      aoi += Format("%3d", state.aoi[static_cast<size_t>(sensor) - 1]);
    }
    text_ += Format("%4d  (%2d, %2d)  %3d  %9.2f  %9.2f  %s  %-7s %-12s  ", state.slot, state.cell.column,
                    state.cell.row, state.time_margin, static_cast<double>(state.energy_margin_j),
                    environment_.remaining_energy_j(), moves.c_str(), covered.c_str(), aoi.c_str());
  }

  Action Choose() {
    const UavState& state = environment_.state();
    Action action;
    for (int sensor = 1; sensor <= world_.sensors(); ++sensor) {
      const auto aoi_of = [&](int s) { return state.aoi[static_cast<size_t>(s) - 1]; };
      if (MaySchedule(sensor) && (action.schedule == 0 || aoi_of(sensor) > aoi_of(action.schedule))) {
        action.schedule = sensor;
      }
    }
    if (next_ < pilot_.waypoints.size() && state.cell == pilot_.waypoints[next_] &&
        waited_++ == pilot_.wait_slots) {
      ++next_;
      waited_ = 0;
    }
    const Cell stop = world_.scenario().stop;
    const Cell goal = next_ < pilot_.waypoints.size() ? pilot_.waypoints[next_] : stop;
    action.move = MoveTowards(world_.map(), state.cell, goal);
    if (pilot_.obeys_mask && !MayMove(action.move)) {
      action.move = MoveTowards(world_.map(), state.cell, stop);
    }
    return action;
  }

  UavWorld world_;
  UavEnvironment environment_;
  Pilot pilot_;
  size_t next_ = 0;  // waypoint
  int waited_ = 0;   // slots over it
  std::string text_;
};

void ExpectGolden(const std::string& name, const Scenario& scenario, Pilot pilot) {
  ExpectGoldenText(name, EpisodeText(scenario, std::move(pilot)).Fly());
}

TEST(GoldenEpisodes, TableOneOverAllThreeSensors) {
  ExpectGolden("table_one", TableOneScenario(), {{{8, 7}, {1, 4}, {18, 19}}, 2});
}

TEST(GoldenEpisodes, TightEnergyAllowsElevenHovers) {
  Scenario scenario = TableOneScenario();
  scenario.initial_energy_j = 9000;
  ExpectGolden("tight_energy", scenario, {{{8, 7}, {1, 4}}, 9});
}

/// Everything that the others leave at its default.
Scenario UnusualScenario() {
  Scenario scenario = TableOne();
  scenario.columns = 6;
  scenario.rows = 4;
  scenario.slots = 14;
  scenario.slot_s = 2;
  scenario.cell_m = 50;
  scenario.start = {5, 3};
  scenario.stop = {0, 3};
  scenario.sensors = {{210, 40, 1}, {60, 0, 3}};
  scenario.coverage_radius_m = 60;
  scenario.initial_energy_j = 6500;
  scenario.rotor = LiteratureRotor();
  scenario.reward = {2, 3, 5};
  scenario.maximum_aoi = 6;
  return scenario;
}

TEST(GoldenEpisodes, CappedAoiWeightsAndAnotherRotor) {
  ExpectGolden("capped_aoi", UnusualScenario(), {{{4, 1}, {1, 0}}, 0});
}

TEST(GoldenEpisodes, ATownWithHousesAndAPark) {
  Scenario scenario = UnusualScenario();
  scenario.map = std::make_shared<ObstacleMap>(std::vector<std::string>{
      "S..B.S",
      ".R.B..",
      ".R....",
      "..N...",
  });
  ExpectGolden("town", scenario, {{{4, 1}, {1, 0}}, 0});
}

TEST(GoldenEpisodes, WithoutTheMaskTheUavGetsLost) {
  ExpectGolden("lost", UnusualScenario(), {{{4, 1}}, 9, false});
}

}  // namespace
}  // namespace fresco
