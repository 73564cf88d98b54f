// A checked scenario with everything derived from it once: coverage, energies, distances, action
// numbering, reachability. Immutable after construction, so any number of threads may share one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "uav/scenario.h"

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

  const Scenario& scenario() const { return scenario_; }
  int sensors() const { return static_cast<int>(scenario_.sensors.size()); }  ///< N
  int actions() const { return kMoves * (sensors() + 1); }
  int inputs() const { return sensors() + 4; }
  int maximum_transitions() const { return scenario_.slots - 1; }

  /// theta_n, summing to one.
  std::span<const double> theta() const { return theta_; }

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
  int ActionIndex(Action action) const { return static_cast<int>(action.move) * (sensors() + 1) + action.schedule; }
  Action ActionAt(int index) const;

 private:
  Scenario scenario_;
  std::vector<double> theta_;
  std::vector<uint8_t> coverage_;
  double flying_energy_j_ = 0;
  double hovering_energy_j_ = 0;
};

/// Delta_t: the joules that are left after the cheapest completion from `cell` with `slots_left`
/// moves to make and `remaining_j` joules on board. With P(V) <= P(0) that is flying in every slot
/// left; otherwise flying the distance and hovering the slack. (Where time_margin < 0 the distance
/// is not completed; the energy of the slots left is counted all the same.)
double EnergyMargin(const World& world, Cell cell, int slots_left, double remaining_j);

/// Whether the stop can still be reached from a situation: time, energy, and where hovering is the
/// dearer and the slack is odd, one hover.
bool CanReachStop(const World& world, Cell cell, int slots_left, double remaining_j);

/// The network's input: [column/(columns-1), row/(rows-1), delta_n/T.., phi/T, Delta/E_max]; a grid of
/// one column or row gives 0 there. `input` has inputs() entries. A pure function of the state as it
/// is on the wire, so that actor and learner see the same bits.
void WriteNetworkInput(const World& world, const State& state, std::span<float> input);

}  // namespace fresco
