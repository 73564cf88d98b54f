// The world of the paper: a checked scenario with everything that is derived from it: coverage, energies,
// distances, the numbering of actions, reachability. Immutable after construction, so any number of threads
// may share one.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/error.h"
#include "worlds/uav/network_input.h"
#include "worlds/uav/obstacle_map.h"
#include "worlds/uav/scenario.h"
#include "worlds/world.h"

namespace fresco {

enum class Move : uint8_t { kNorth = 0, kSouth = 1, kEast = 2, kWest = 3, kHover = 4 };
inline constexpr int kMoves = 5;
/// What each move adds to column and row.
inline constexpr std::array<Cell, kMoves> kMoveSteps = {{{0, 1}, {0, -1}, {1, 0}, {-1, 0}, {0, 0}}};

/// "north", "south", "east", "west", "hover".
const char* MoveName(Move move);

/// An action of the paper: a move v_t and a scheduled sensor b_t.
struct Action {
  Move move = Move::kHover;
  int schedule = 0;  ///< the sensor that transmits, 1 .. N; 0: none
  bool operator==(const Action&) const = default;
};

/// The state s_t of the paper in its natural units. As floats (WorldDescription::state), its fields follow
/// each other in this order, without the slot: state i of an episode that begins at the start is that of slot
/// i + 1.
struct UavState {
  int slot = 1;               ///< t, 1 .. T
  Cell cell;                  ///< o_t
  int time_margin = 0;        ///< phi_t, slots; negative: the stop can't be reached in time
  float energy_margin_j = 0;  ///< Delta_t, joules; negative: the energy does not last to the stop
  std::vector<int16_t> aoi;   ///< delta_{n,t}, slots, one entry for each sensor, 1 .. T (or maximum_aoi)
};

/// Where each field is in a state as floats.
inline constexpr size_t kColumnField = 0;
inline constexpr size_t kRowField = 1;
inline constexpr size_t kTimeMarginField = 2;
inline constexpr size_t kEnergyMarginField = 3;
inline constexpr size_t kAoiField = 4;  ///< of the first sensor; the others follow

/// Which actions the mask forbids.
struct MaskOptions {
  /// Forbid moves off the grid or over an obstacle, and moves after which the stop can't be reached.
  bool safe_actions = false;
  bool coverage = false;  ///< forbid scheduling sensors that the UAV does not cover now
  /// Forbid scheduling no sensor while the UAV covers one. To schedule that one is never worse: its AoI
  /// becomes 1, everything else stays the same.
  bool idle = false;
};

/// How agents see the world and what they may do in it; the scenario is the same.
struct UavOptions {
  MaskOptions mask = {};
  NetworkInputOptions network_input = {};
};

/// The order of the figures by which the world judges an episode (AoiFigures).
enum class UavFigure : size_t { kAverageAoi = 0, kTotalAoi = 1, kSumAoi = 2 };

class UavWorld : public World {
 public:
  /// Every value must be in its range (msgs/proto/experiment.proto; Experiment checks it). Throws UsageError
  /// if values do not fit together: a start off the grid or over an obstacle, a map of another size, a sensor
  /// off the map, weights that sum to 0, more cells and sensors than memory allows, a speed that is not one
  /// cell a slot, an update that no signal could carry, or a stop that can't be reached in time and energy.
  /// The error names the scenario's field, the value and what is allowed.
  explicit UavWorld(Scenario scenario, UavOptions options = {});

  std::unique_ptr<Environment> NewEnvironment() const override;
  void Observe(std::span<const float> state, std::span<float> observation) const override;
  std::optional<StateFormulas> Formulate(Formulas& formulas) const override;
  void Judge(const Episode& episode, std::span<double> figures) const override;
  bool Succeeded(const Episode& episode) const override;
  /// Tells a flight from the start: arrived, outcome, slots, total_aoi, average_aoi, sum_aoi and
  /// residual_energy_j; for each slot of `flight` slot, column, row, move, scheduled, and aoi at its
  /// beginning.
  EpisodeAccount Tell(const Episode& flight) const override;
  /// The paper's two comparison algorithms (worlds/uav/baselines.h).
  std::vector<ReferencePolicy> reference_policies() const override;
  /// The seed decides nothing.
  Episode FlyReference(const std::string& name, uint64_t seed = 0) const override;
  /// The places of excursions are the cells; with a map, those that flights from the start lead to.
  bool has_places() const override { return true; }
  /// The index of a cell (CellIndex).
  int DrawPlace(RandomStream& stream) const override;
  bool IsAt(std::span<const float> state, int place) const override;
  /// One move towards the cell (MoveTowards), with any schedule.
  ActionRange Towards(std::span<const float> state, int place) const override;

  /// The scenario as given; only initial_energy_j is rounded, see flying_energy_j().
  const Scenario& scenario() const { return scenario_; }
  int sensors() const { return static_cast<int>(scenario_.sensors.size()); }  ///< N
  const MaskOptions& mask_options() const { return options_.mask; }

  /// The memory of the map, the coverage table and the other derived values, bytes.
  int64_t bytes() const override;

  /// The weights theta_n [N], which sum to one.
  std::span<const double> theta() const { return theta_; }

  /// The energy of a slot of flight and of a hover, joules. These two and initial_energy_j are rounded to
  /// multiples of a power of two that is about 1e-15 of the whole flight's energy. So sums and differences of
  /// them over a flight are exact in double, in any order, and rounding never decides whether the stop can be
  /// reached.
  double flying_energy_j() const { return flying_energy_j_; }      ///< P(V) tau
  double hovering_energy_j() const { return hovering_energy_j_; }  ///< P(0) tau
  /// Whether the cheapest flight to the stop flies its spare slots to and fro, two at a time: flying takes
  /// less energy than hovering, and the stop has a neighbouring cell that can be flown over.
  bool flies_spare_slots() const { return flies_spare_slots_; }

  /// Numbers the cells row by row, 0 .. columns * rows - 1.
  int CellIndex(Cell cell) const { return cell.row * scenario_.columns + cell.column; }
  bool OnGrid(Cell cell) const {
    // A negative number is a large one without sign.
    return (static_cast<unsigned>(cell.column) < static_cast<unsigned>(scenario_.columns)) &
           (static_cast<unsigned>(cell.row) < static_cast<unsigned>(scenario_.rows));
  }
  /// The map of the scenario; null if it has none.
  const ObstacleMap* map() const { return scenario_.map.get(); }
  /// Whether the UAV may be over a cell: it is on the grid, and the map, if there is one, has no obstacle to
  /// flight there.
  bool MayFly(Cell cell) const { return OnGrid(cell) && (map() == nullptr || map()->MayFly(cell)); }
  /// The cell after a move. A move off the grid or over a cell that can't be flown over leaves the UAV where
  /// it is.
  Cell After(Cell cell, Move move) const {
    const Cell step = kMoveSteps[static_cast<size_t>(move)];
    const Cell next = {cell.column + step.column, cell.row + step.row};
    return MayFly(next) ? next : cell;
  }
  /// The moves of a shortest flight from a cell to the stop: their Manhattan distance, or with a map the way
  /// round the obstacles (ObstacleMap::kCutOff if there is none).
  int DistanceToStop(Cell cell) const {
    if (to_stop_ != nullptr) {
      return to_stop_[CellIndex(cell)];
    }
    return std::abs(cell.column - scenario_.stop.column) + std::abs(cell.row - scenario_.stop.row);
  }
  /// The same between two cells.
  int Distance(Cell a, Cell b) const {
    return map() != nullptr ? map()->Distance(a, b) : std::abs(a.column - b.column) + std::abs(a.row - b.row);
  }

  /// Whether the UAV over `cell` covers a sensor: their horizontal distance is at most R, and, with a map,
  /// radio passes between them (ObstacleMap::HasLineOfSight). Over cells that can't be flown over, nothing is
  /// covered. `sensor` is 0 .. N - 1.
  bool Covers(Cell cell, int sensor) const { return Coverage(cell)[static_cast<size_t>(sensor)] != 0; }
  /// For each sensor 1 if the UAV over `cell` covers it, otherwise 0.
  std::span<const uint8_t> Coverage(Cell cell) const {
    const auto count = static_cast<size_t>(sensors());
    return std::span(coverage_).subspan(static_cast<size_t>(CellIndex(cell)) * count, count);
  }

  /// The index of an action, 0 .. actions() - 1, is move * (N + 1) + schedule. ActionAt CHECKs the index.
  int ActionIndex(Action action) const {
    return static_cast<int>(action.move) * (sensors() + 1) + action.schedule;
  }
  Action ActionAt(int index) const {
    FRESCO_CHECK(index >= 0 && index < actions());
    return actions_[static_cast<size_t>(index)];
  }

 private:
  void DeriveEnergies();
  void DeriveTheta();
  void DeriveCoverage();

  Scenario scenario_;
  UavOptions options_;
  std::vector<Action> actions_;
  std::vector<double> theta_;
  std::vector<uint8_t> coverage_;
  double flying_energy_j_ = 0;
  double hovering_energy_j_ = 0;
  bool flies_spare_slots_ = false;
  const int16_t* to_stop_ = nullptr;           // by CellIndex, in the map's table; null if there is no map
  std::optional<NetworkInput> network_input_;  // always, once the world is constructed
};

/// Throws UsageError if start or stop is off the grid, or if they do not fit the scenario's map, or the map
/// does not fit the grid. UavWorld does the same.
void CheckPlaces(const Scenario& scenario);

/// The world as a UavWorld; null if it is another kind of world. What only this kind has (baselines, an exact
/// optimum, drawings of flights) begins here.
const UavWorld* AsUavWorld(const World& world);
/// The same. Throws UsageError if it is another kind of world: "a flight: …". `what` says who needs it.
const UavWorld& RequireUavWorld(const World& world, const std::string& what);

/// Returns Delta_t: the joules left after `slots_left` more slots with `remaining_j` joules on board, from a
/// cell that is `distance` moves away from the stop. If flying takes no more energy than hovering, P(V) <=
/// P(0), all these slots are counted as flown, as in the paper. (That is an upper bound: an odd number of
/// spare slots takes a hover, see CompletionEnergy.) Otherwise the distance to the stop is flown and the
/// spare slots are hovered. If time_margin < 0, there are no spare slots.
inline double EnergyMargin(const UavWorld& world, int distance, int slots_left, double remaining_j) {
  const int flown =
      world.flying_energy_j() <= world.hovering_energy_j() ? slots_left : std::min(distance, slots_left);
  return remaining_j - flown * world.flying_energy_j() - (slots_left - flown) * world.hovering_energy_j();
}
/// The same for a cell.
inline double EnergyMargin(const UavWorld& world, Cell cell, int slots_left, double remaining_j) {
  return EnergyMargin(world, world.DistanceToStop(cell), slots_left, remaining_j);
}

/// Returns the joules of the cheapest flight to a stop that is so many cells away, in exactly `slots_left`
/// slots, which are at least the distance. If flying takes no less energy than hovering, the spare slots are
/// hovered. Otherwise they are flown to and fro, two at a time, so only an odd number of them takes one
/// hover. (On a grid of a single cell there is nowhere to fly, so all of them are hovered.)
inline double CompletionEnergy(const UavWorld& world, int distance, int slots_left) {
  const int spare = slots_left - distance;
  const int hovered = world.flies_spare_slots() ? spare & 1 : spare;
  return (slots_left - hovered) * world.flying_energy_j() + hovered * world.hovering_energy_j();
}

/// Whether a stop that is so many cells away can still be reached in `slots_left` slots with `remaining_j`
/// joules. This is exact.
inline bool CanReachStop(const UavWorld& world, int distance, int slots_left, double remaining_j) {
  return (distance <= slots_left) & (remaining_j >= CompletionEnergy(world, distance, slots_left));
}

/// Returns the move towards `to` along the axis with the larger distance, along columns if they are equal; a
/// hover if `from` is `to`.
Move MoveTowards(Cell from, Cell to);
/// The first move of a shortest flight between two cells of a map: of the moves that lead closer, that of an
/// open grid (above) if it is one of them, otherwise the first one of north, south, east, west. A hover if
/// `from` is `to`, or if no flight leads there. If `map` is null, the grid is open.
Move MoveTowards(const ObstacleMap* map, Cell from, Cell to);

}  // namespace fresco
