// One flown episode and its figures of merit, in the three forms that Fresco reports everywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "worlds/uav/baselines.h"
#include "worlds/uav/environment.h"

namespace fresco {

/// One slot of a flight: the state at its beginning and what was done in it. In the last one no
/// decision is made (over the stop at slot T, or the episode has ended early): hover, schedule 0.
struct FlightSlot {
  State state;
  Action action;
};

/// The AoI figures over t = 1..T of a flight.
struct AoiFigures {
  int64_t total_aoi = 0;   ///< sum_t sum_n delta_{n,t}
  double average_aoi = 0;  ///< J = (1/T) sum_t sum_n theta_n delta_{n,t}, theta summing to one
  double sum_aoi = 0;      ///< J with theta_n = 1
};

struct Flight {
  std::vector<FlightSlot> slots;  ///< from 1 to the terminal state: T of them, or fewer
  Outcome outcome = Outcome::kFlying;
  double residual_energy_j = 0;
  double total_reward = 0;
  bool arrived() const { return outcome == Outcome::kArrived; }
};

/// The figures of states t = 1, 2, ...; a flight that ended early is charged as if nothing were
/// collected any more until slot T, so that ending early never looks better.
class AoiAccumulator {
 public:
  explicit AoiAccumulator(const World& world) : world_(&world) {}
  void Add(std::span<const int16_t> aoi);
  /// At least one state must have been added.
  AoiFigures Finish() const;

 private:
  const World* world_;
  int slots_ = 0;
  int64_t total_ = 0;
  double weighted_ = 0;
  std::vector<int16_t> last_;
};

AoiFigures Figures(const World& world, const Flight& flight);

/// By how many percent an average AoI lies above the least possible one. (Above a lower bound on that one it
/// says only how large the gap is at most; whoever shows it must say so.)
double GapPercent(double average_aoi, double least_average_aoi);

/// Flies one episode from the start with the actions of `policy`.
Flight Fly(const World& world, const std::function<Action(const Environment&)>& policy);

/// One episode of a baseline.
Flight FlyBaseline(const World& world, BaselineKind kind);

}  // namespace fresco
