// The paper's two comparison algorithms (section IV), with the choices of docs/paper.md. Deterministic; no
// I/O. Only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <vector>

#include "worlds/uav/flight.h"

namespace fresco {

/// How a baseline chooses the sensor that it flies to. It chooses after the slot's transmission, so the
/// sensor that transmits in the slot counts as served. Of equal sensors it takes the lowest index.
enum class BaselineKind {
  kAoi,       ///< the sensor with the largest AoI
  kDistance,  ///< in rounds: the nearest sensor that was not served in this round yet. With a map, by the
              ///< moves to the cell that the UAV would fly to; of equal ones, the nearest in metres
};

/// A baseline that flies one episode at a time. In each slot it schedules the covered sensor with the largest
/// AoI and flies one cell towards the cell nearest to its target, along the axis with the larger distance
/// (columns if they are equal). With a map, it flies to the nearest of the cells that cover its target (of
/// the cells that flights lead to, if none covers it), by a shortest way round the obstacles (MoveTowards in
/// uav_world.h). As soon as that move would put the stop out of reach, it flies to the stop
/// and stays there, so it always arrives.
class Baseline {
 public:
  /// `world` must outlive the object.
  Baseline(BaselineKind kind, const UavWorld& world);
  /// Prepares for a new episode.
  void Reset();
  /// Returns the action for the environment's present state. Call it once in each slot: it updates the round
  /// of the distance baseline.
  Action Choose(const UavEnvironment& environment);

 private:
  int NextOfRound(Cell cell, int served_now);

  BaselineKind kind_;
  const UavWorld* world_;
  std::vector<Cell> goals_;      // by sensor: the cell to fly to
  std::vector<uint8_t> served_;  // by sensor: 1 if served in this round; for kDistance only
  bool returning_ = false;       // on the way to the stop until the episode ends
};

/// Flies one episode of a baseline.
Episode FlyBaseline(const UavWorld& world, BaselineKind kind);

}  // namespace fresco
