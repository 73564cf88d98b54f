// The paper's two comparison algorithms (section IV), with the choices of docs/paper.md. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "worlds/uav/environment.h"

namespace fresco {

/// The target, chosen after the slot's transmission (it comes before the move, and what it serves
/// counts as served). Ties: the lowest index.
enum class BaselineKind {
  kAoi,       ///< the sensor with the largest AoI
  kDistance,  ///< in rounds: the nearest sensor not yet served in this round
};

/// A baseline flying one episode at a time: a cell a slot towards the cell nearest to its target, along
/// the axis with the larger distance (ties: columns). Serves on the way the covered sensor with the largest
/// AoI; flies to the stop as soon as the wanted move would put it out of reach, and stays there, so it
/// always arrives.
class Baseline {
 public:
  Baseline(BaselineKind kind, const World& world);
  void Reset();
  /// The action for the environment's present state; updates the round of the distance baseline.
  Action Choose(const Environment& environment);

 private:
  int NextOfRound(Cell cell, int served_now);

  BaselineKind kind_;
  const World* world_;
  std::vector<uint8_t> served_;  // this round, kDistance only
  bool returning_ = false;       // on the way to the stop, for good
};

}  // namespace fresco
