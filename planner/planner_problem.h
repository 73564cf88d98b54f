// The exact planner's problem in whole numbers: sensors that count, integer weights, what each slot
// and cell allows. Immutable after construction. Used by the planner's own parts only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "worlds/uav/world.h"

namespace fresco {

inline constexpr std::array kAllMoves = {Move::kNorth, Move::kSouth, Move::kEast, Move::kWest, Move::kHover};

/// The planner minimises sum_t sum_n weight_n delta_{n,t} over flights that arrive. Sensors of weight
/// zero are left out. Weights are whole numbers: exact where the scenario's are multiples of a common
/// fraction (1, 2, 0.25, ...), otherwise rounded down, so that a lower bound stays one.
class PlannerProblem {
 public:
  /// `world` must outlive the problem.
  explicit PlannerProblem(const World& world);

  const World& world() const { return *world_; }
  int slots() const { return world_->scenario().slots; }
  int cells() const { return world_->scenario().columns * world_->scenario().rows; }
  int start() const { return world_->CellIndex(world_->scenario().start); }

  /// The sensors that count, as indices into the scenario's.
  const std::vector<int>& sensors() const { return sensors_; }
  int size() const { return static_cast<int>(sensors_.size()); }
  /// So small that the cost of any flight stays below 2^50, exact in a double.
  const std::vector<int64_t>& weights() const { return weights_; }
  /// Whether the whole weights stand to each other as the scenario's do (but for double's own rounding).
  bool has_exact_weights() const { return has_exact_weights_; }
  /// Whether all sensors that count weigh the same; then the cost is in slots of AoI.
  bool has_equal_weights() const;
  /// One unit of cost, as average AoI (J of the paper).
  double average_aoi_per_unit() const { return average_aoi_per_unit_; }

  /// The AoI's cap; the number of slots where there is none.
  int maximum_aoi() const { return maximum_aoi_; }
  bool is_capped() const { return maximum_aoi_ < slots(); }
  int NextAoi(int aoi) const { return aoi < maximum_aoi_ ? aoi + 1 : aoi; }
  bool Covers(int cell, int sensor) const {
    return world_->Covers(CellAt(cell), sensors_[static_cast<size_t>(sensor)]);
  }

  Cell CellAt(int cell) const {
    return {cell % world_->scenario().columns, cell / world_->scenario().columns};
  }
  /// The cell after a move, -1 where it leaves the grid.
  int After(int cell, Move move) const {
    return after_[static_cast<size_t>(cell) * kMoves + static_cast<size_t>(move)];
  }

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
  void TakeMoves();

  const World* world_;
  std::vector<int32_t> after_;  // by cell and move
  std::vector<int> sensors_;
  std::vector<int64_t> weights_;
  bool has_exact_weights_ = false;
  double average_aoi_per_unit_ = 0;
  int maximum_aoi_;
  bool hovering_is_dearer_;
  bool energy_binds_ = false;
  int dear_slots_ = 0;
  double cheap_energy_j_ = 0;  // of a slot
  double extra_energy_j_ = 0;  // of a dear slot over a cheap one
};

}  // namespace fresco
