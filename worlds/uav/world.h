// A checked scenario with everything derived from it once: coverage, energies, distances, action
// numbering, reachability. Immutable after construction, so any number of threads may share one.
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

/// v_t and b_t: a move, and the scheduled sensor 1..N or 0 for none (as in the paper).
struct Action {
  Move move = Move::kHover;
  int schedule = 0;
  bool operator==(const Action&) const = default;
};

/// s_t of the paper as it goes over the wire: small integers and joules, readable as they are.
/// `aoi` is in slots, one entry a sensor, 1..T (or the cap).
struct State {
  int slot = 1;               ///< t, 1..T
  Cell cell;                  ///< o_t
  int time_margin = 0;        ///< phi_t, in slots; negative: the stop is out of reach in time
  float energy_margin_j = 0;  ///< Delta_t in joules; negative: the stop is out of reach in energy
  std::vector<int16_t> aoi;   ///< delta_{n,t}
};

class World {
 public:
  /// Checks every value (finite, in range, start and stop on the grid, the stop reachable in time
  /// and energy) and throws UsageError naming the scenario's field, the value and what is allowed.
  explicit World(Scenario scenario);

  /// As given, but for initial_energy_j: see flying_energy_j().
  const Scenario& scenario() const { return scenario_; }
  int sensors() const { return static_cast<int>(scenario_.sensors.size()); }  ///< N
  int actions() const { return kMoves * (sensors() + 1); }
  int maximum_transitions() const { return scenario_.slots - 1; }

  /// What the world takes of memory beside the object itself.
  int64_t bytes() const;

  /// theta_n, summing to one.
  std::span<const double> theta() const { return theta_; }

  /// Energy of a slot. These two and the scenario's initial_energy_j are rounded to multiples of one
  /// power of two, about 1e-15 of the whole flight's energy: sums and differences of them over a
  /// flight are exact in double, in any order, so no rounding decides what is within reach.
  double flying_energy_j() const { return flying_energy_j_; }      ///< P(V) tau
  double hovering_energy_j() const { return hovering_energy_j_; }  ///< P(0) tau

  int CellIndex(Cell cell) const { return cell.row * scenario_.columns + cell.column; }
  bool OnGrid(Cell cell) const;
  /// The cell after a move; off the grid the UAV stays where it is.
  Cell After(Cell cell, Move move) const;
  /// Manhattan distance to the stop, in cells.
  int DistanceToStop(Cell cell) const;

  /// Whether the UAV over `cell` covers sensor n (0-based): horizontal distance <= R.
  bool Covers(Cell cell, int sensor) const {
    return coverage_[static_cast<size_t>(CellIndex(cell)) * static_cast<size_t>(sensors()) +
                     static_cast<size_t>(sensor)] != 0;
  }

  /// action index = move * (N + 1) + schedule.
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

/// Delta_t: the joules that are left after `slots_left` more moves from `cell` with `remaining_j`
/// joules on board. With P(V) <= P(0) all of them are counted as flown, as in the paper (a bound: an
/// odd slack takes a hover more, see CompletionEnergy); otherwise the distance is flown and the slack
/// hovered. (Where time_margin < 0 the distance is not completed, and every slot left is flown.)
double EnergyMargin(const World& world, Cell cell, int slots_left, double remaining_j);

/// The joules of the cheapest flight from `cell` to the stop in exactly `slots_left` moves, at least
/// the distance. Where hovering is the dearer, slack is flown to and fro, two slots at a time, so only
/// an odd slack takes a hover (on a grid of a single cell there is nowhere to fly, and all of it is
/// hovered); otherwise the slack is hovered.
double CompletionEnergy(const World& world, Cell cell, int slots_left);

/// One cell along the axis with the larger distance, columns first at equal ones; hover when there.
Move MoveTowards(Cell from, Cell to);

/// Whether the stop can still be reached from a situation: exactly, in time and in energy.
bool CanReachStop(const World& world, Cell cell, int slots_left, double remaining_j);

}  // namespace fresco
