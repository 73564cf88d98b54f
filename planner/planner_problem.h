// The exact planner's problem in whole numbers: the sensors that count, integer weights, and what each slot
// and cell allows. Immutable after construction, so threads may share one. Only parts of the planner use it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "worlds/uav/uav_world.h"

namespace fresco {

inline constexpr std::array kAllMoves = {Move::kNorth, Move::kSouth, Move::kEast, Move::kWest, Move::kHover};

/// The planner minimises sum_t sum_n weight_n delta_{n,t} over the flights that arrive. Sensors of weight
/// zero are left out. Weights are whole numbers. They are exact if the scenario's weights are multiples of a
/// common fraction (1, 2, 0.25, ...); otherwise they are rounded down, so that lower bounds stay lower
/// bounds.
class PlannerProblem {
 public:
  /// `world` must outlive the problem.
  explicit PlannerProblem(const UavWorld& world);

  const UavWorld& world() const { return *world_; }
  int slots() const { return world_->scenario().slots; }
  int cells() const { return world_->scenario().columns * world_->scenario().rows; }
  int start() const { return world_->CellIndex(world_->scenario().start); }

  /// The sensors with positive weight, as indices into the scenario's sensors.
  const std::vector<int>& sensors() const { return sensors_; }
  int size() const { return static_cast<int>(sensors_.size()); }
  /// One weight for each of these, so small that the cost of any flight is below 2^50 and exact in a double.
  const std::vector<int64_t>& weights() const { return weights_; }
  /// Whether the ratios of the whole weights are those of the scenario's weights, apart from the rounding of
  /// doubles.
  bool has_exact_weights() const { return has_exact_weights_; }
  /// Whether all these sensors have the same weight; then one unit of cost is one slot of AoI.
  bool has_equal_weights() const;
  /// One unit of cost, as average AoI (J of the paper).
  double average_aoi_per_unit() const { return average_aoi_per_unit_; }

  /// The maximum AoI of the scenario; the number of slots if it has none.
  int maximum_aoi() const { return maximum_aoi_; }
  bool is_capped() const { return maximum_aoi_ < slots(); }
  /// The AoI in the next slot if the sensor is not served.
  int NextAoi(int aoi) const { return aoi < maximum_aoi_ ? aoi + 1 : aoi; }
  /// Whether the UAV over a cell covers a sensor, an index into sensors().
  bool Covers(int cell, int sensor) const {
    return world_->Covers(CellAt(cell), sensors_[static_cast<size_t>(sensor)]);
  }

  Cell CellAt(int cell) const {
    return {cell % world_->scenario().columns, cell / world_->scenario().columns};
  }
  /// The cell after a move; -1 if the move leads off the grid or over a cell that can't be flown over.
  int After(int cell, Move move) const {
    return after_[static_cast<size_t>(cell) * kMoves + static_cast<size_t>(move)];
  }

  /// A slot is dear if its move is of the kind that takes more energy: hovering in some scenarios, flying in
  /// others. A flight's energy depends only on its number of dear slots. energy_binds says whether the budget
  /// limits this number.
  bool energy_binds() const { return energy_binds_; }
  /// Whether a slot with this move is dear.
  bool IsDear(Move move) const { return (move == Move::kHover) == hovering_is_dearer_; }
  /// The most dear slots that a flight can have.
  int dear_slots() const { return dear_slots_; }
  /// The most dear slots before `slot` with which a UAV that is over `cell` at the beginning of `slot` can
  /// still reach the stop in time and energy. Negative: it can't be there at all.
  int DearAllowance(int slot, int cell) const;

 private:
  void ScaleWeights();
  void ComputeEnergies();
  void TabulateMoves();

  const UavWorld* world_;
  std::vector<int32_t> after_;  // by cell and move
  std::vector<int> sensors_;
  std::vector<int64_t> weights_;
  bool has_exact_weights_ = false;
  double average_aoi_per_unit_ = 0;
  int maximum_aoi_;
  bool hovering_is_dearer_;
  bool energy_binds_ = false;
  int dear_slots_ = 0;
  double cheap_energy_j_ = 0;  // energy of a slot that is not dear
  double extra_energy_j_ = 0;  // how much more energy a dear slot takes
};

}  // namespace fresco
