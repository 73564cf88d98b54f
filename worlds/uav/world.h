// A world is a checked scenario with everything that is derived from it: coverage, energies, distances, the
// numbering of actions, reachability. Immutable after construction, so any number of threads may share one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "worlds/uav/scenario.h"

namespace fresco {

enum class Move : uint8_t { kNorth = 0, kSouth = 1, kEast = 2, kWest = 3, kHover = 4 };
inline constexpr int kMoves = 5;

/// "north", "south", "east", "west", "hover".
const char* MoveName(Move move);

/// An action of the paper: a move v_t and a scheduled sensor b_t.
struct Action {
  Move move = Move::kHover;
  int schedule = 0;  ///< the sensor that transmits, 1 .. N; 0: none
  bool operator==(const Action&) const = default;
};

/// The state s_t of the paper in its natural units, as messages carry it.
struct State {
  int slot = 1;               ///< t, 1 .. T
  Cell cell;                  ///< o_t
  int time_margin = 0;        ///< phi_t, slots; negative: the stop can't be reached in time
  float energy_margin_j = 0;  ///< Delta_t, joules; negative: the energy does not last to the stop
  std::vector<int16_t> aoi;   ///< delta_{n,t}, slots, one entry for each sensor, 1 .. T (or maximum_aoi)
};

class World {
 public:
  /// Every value must be in its range (msgs/proto/experiment.proto; Experiment checks it). Throws UsageError
  /// if values do not fit together: a start off the grid, weights that sum to 0, more cells and sensors than
  /// memory allows, a speed that is not one cell a slot, an update that no signal could carry, or a stop that
  /// can't be reached in time and energy. The error names the scenario's field, the value and what is
  /// allowed.
  explicit World(Scenario scenario);

  /// The scenario as given; only initial_energy_j is rounded, see flying_energy_j().
  const Scenario& scenario() const { return scenario_; }
  int sensors() const { return static_cast<int>(scenario_.sensors.size()); }  ///< N
  int actions() const { return kMoves * (sensors() + 1); }                    ///< 5 (N + 1)
  int maximum_transitions() const { return scenario_.slots - 1; }             ///< of an episode, T - 1

  /// The memory of the coverage table and the other derived values, bytes.
  int64_t bytes() const;

  /// The weights theta_n [N], which sum to one.
  std::span<const double> theta() const { return theta_; }

  /// The energy of a slot of flight and of a hover, joules. These two and initial_energy_j are rounded to
  /// multiples of a power of two that is about 1e-15 of the whole flight's energy. So sums and differences of
  /// them over a flight are exact in double, in any order, and rounding never decides whether the stop can be
  /// reached.
  double flying_energy_j() const { return flying_energy_j_; }      ///< P(V) tau
  double hovering_energy_j() const { return hovering_energy_j_; }  ///< P(0) tau

  /// Numbers the cells row by row, 0 .. columns * rows - 1.
  int CellIndex(Cell cell) const { return cell.row * scenario_.columns + cell.column; }
  bool OnGrid(Cell cell) const;
  /// The cell after a move. A move off the grid leaves the UAV where it is.
  Cell After(Cell cell, Move move) const;
  /// Manhattan distance to the stop, in cells.
  int DistanceToStop(Cell cell) const;

  /// Whether the UAV over `cell` covers a sensor: their horizontal distance is at most R. `sensor` is 0 .. N
  /// - 1.
  bool Covers(Cell cell, int sensor) const {
    return coverage_[static_cast<size_t>(CellIndex(cell)) * static_cast<size_t>(sensors()) +
                     static_cast<size_t>(sensor)] != 0;
  }

  /// The index of an action, 0 .. actions() - 1, is move * (N + 1) + schedule. ActionAt CHECKs the index.
  int ActionIndex(Action action) const {
    return static_cast<int>(action.move) * (sensors() + 1) + action.schedule;
  }
  Action ActionAt(int index) const;

 private:
  void DeriveEnergies();
  void DeriveTheta();
  void DeriveCoverage();

  Scenario scenario_;
  std::vector<double> theta_;
  std::vector<uint8_t> coverage_;
  double flying_energy_j_ = 0;
  double hovering_energy_j_ = 0;
};

/// Returns Delta_t: the joules left after `slots_left` more slots from `cell` with `remaining_j` joules on
/// board. If flying takes no more energy than hovering, P(V) <= P(0), all these slots are counted as flown,
/// as in the paper. (That is an upper bound: an odd number of spare slots takes a hover, see
/// CompletionEnergy.) Otherwise the distance to the stop is flown and the spare slots are hovered. If
/// time_margin < 0, there are no spare slots.
double EnergyMargin(const World& world, Cell cell, int slots_left, double remaining_j);

/// Returns the joules of the cheapest flight from `cell` to the stop in exactly `slots_left` slots; CHECKs
/// that these are at least the distance. If flying takes no less energy than hovering, the spare slots are
/// hovered. Otherwise they are flown to and fro, two at a time, so only an odd number of them takes one
/// hover. (On a grid of a single cell there is nowhere to fly, so all of them are hovered.)
double CompletionEnergy(const World& world, Cell cell, int slots_left);

/// Returns the move towards `to` along the axis with the larger distance, along columns if they are equal; a
/// hover if `from` is `to`.
Move MoveTowards(Cell from, Cell to);

/// Whether the stop can still be reached from `cell` in `slots_left` slots with `remaining_j` joules. This is
/// exact.
bool CanReachStop(const World& world, Cell cell, int slots_left, double remaining_j);

}  // namespace fresco
