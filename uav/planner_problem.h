// The exact planner's problem in whole numbers: sensors that count, integer weights, what each slot
// and cell allows. Immutable after construction. Used by cost_to_go, label_search and planner only.
#pragma once

#include <cstdint>
#include <vector>

#include "uav/world.h"

namespace fresco {

/// The planner minimises sum_t sum_n weight_n delta_{n,t} over flights that arrive. Sensors of weight
/// zero are left out. Weights are whole numbers: exact where the scenario's are multiples of a common
/// fraction (1, 2, 0.25, ...), otherwise rounded down to about a millionth of their sum, so that a
/// lower bound stays one.
class PlannerProblem {
 public:
  /// `world` must outlive the problem.
  explicit PlannerProblem(const World& world);

  const World& world() const { return *world_; }
  int slots() const { return world_->scenario().slots; }
  int cells() const { return world_->scenario().columns * world_->scenario().rows; }

  /// The sensors that count, as indices into the scenario's.
  const std::vector<int>& sensors() const { return sensors_; }
  int size() const { return static_cast<int>(sensors_.size()); }
  const std::vector<int32_t>& weights() const { return weights_; }
  /// One unit of cost, as average AoI (J of the paper).
  double average_aoi_per_unit() const { return average_aoi_per_unit_; }

  /// The AoI's cap; the number of slots where there is none.
  int maximum_aoi() const { return maximum_aoi_; }
  int NextAoi(int aoi) const { return aoi < maximum_aoi_ ? aoi + 1 : aoi; }
  bool Covers(int cell, int sensor) const {
    return world_->Covers(CellAt(cell), sensors_[static_cast<size_t>(sensor)]);
  }

  Cell CellAt(int cell) const {
    return {cell % world_->scenario().columns, cell / world_->scenario().columns};
  }
  /// The cell after a move, -1 where it leaves the grid.
  int After(int cell, Move move) const;

  /// Of hovering and flying a slot, one is the dearer in energy; flights differ in how many slots they
  /// spend on it. Whether the budget limits that number at all:
  bool energy_binds() const { return energy_binds_; }
  bool IsDear(Move move) const { return (move == Move::kHover) == hovering_is_dearer_; }
  /// How many dear slots a flight may have in all.
  int dear_slots() const { return dear_slots_; }
  /// How many dear slots a UAV may have had that is over `cell` at the beginning of `slot`, so that it
  /// can still reach the stop in time and energy; negative: it can't be there at all.
  int DearAllowance(int slot, int cell) const;

 private:
  void TakeSensors();
  void TakeEnergies();

  const World* world_;
  std::vector<int> sensors_;
  std::vector<int32_t> weights_;
  double average_aoi_per_unit_ = 0;
  int maximum_aoi_;
  bool hovering_is_dearer_;
  bool energy_binds_ = false;
  int dear_slots_ = 0;
  double cheap_energy_j_ = 0;  // of a slot
  double extra_energy_j_ = 0;  // of a dear slot over a cheap one
};

}  // namespace fresco
