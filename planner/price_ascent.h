// Finds prices that make the planner's lower bound large. If the UAV flew for one sensor alone, that sensor's
// least cost would be easy to compute, and the sum of these optima over all sensors is a lower bound of any
// flight's cost. But it is a weak one, since each sensor's best flight is another. So each sensor pays a
// price for the UAV being over a cell (it is paid if the price is negative), and a price for transmitting
// there. In every flight the prices of all sensors sum to zero or less, so the sum of the optima at these
// prices is a lower bound, too (Lagrangian decomposition). The ascent goes through the slots back and forth.
// It sets the prices of each cell so that the best flight through this cell costs every sensor the same
// (min-marginal averaging, as TRW-S does it for graphical models). No step lowers the bound. Deterministic.
// Only one thread may use an object.
//
// Reference: V. Kolmogorov, "Convergent tree-reweighted message passing for energy minimization", IEEE
// TPAMI 28(10), 2006.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planner/slot_cells.h"

namespace fresco {

/// The prices, in units of cost. They are floating point, so they must be rounded to whole numbers
/// (WholePrices) before they prove anything.
struct CellPrices {
  /// The price of the UAV being there, for each place (SlotCells) and sensor: [places x sensors]. In every
  /// place, these prices and `transmission` sum to zero.
  std::vector<float> presence;
  std::vector<float> transmission;  ///< the price of being served there, for each place; >= 0
  double dear_slot = 0;             ///< the price of a dear slot; all sensors pay equal shares of it
};

class PriceAscent {
 public:
  /// An AoI larger than `aoi_limit` counts as `aoi_limit`. All references must outlive the object.
  PriceAscent(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit, WorkMeter& meter);

  /// Improves the prices until the bound rises only slowly, or the meter stops.
  void Run();

  const CellPrices& prices() const { return prices_; }

  /// The memory of an object, bytes.
  static int64_t Bytes(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit);

 private:
  /// The least cost of a sensor's flights through a place.
  struct Marginals {
    float unserved = 0;  ///< least cost of the flights that do not serve the sensor there
    float gain = 0;      ///< how much less those cost that serve it there; >= 0
  };

  int Width(int slot) const;
  size_t Offset(int slot, size_t number) const;
  /// Computes the lower bound at the present prices.
  double Evaluate();
  void ImproveDearPrice();
  void SweepBackward(bool reprice);
  void SweepForward();
  void ComputeBestNext(int slot, int cell);
  Marginals MarginalsOf(size_t sensor, const float* forward, int slot, bool covered);
  void Reprice(int slot, size_t number, int cell);
  void StoreBackward(int slot, size_t number, int cell);
  void PushForward(int slot, size_t number, int cell);
  float DearShare(Move move) const;

  const PlannerProblem* problem_;
  const SlotCells* slot_cells_;
  int aoi_limit_;
  WorkMeter* meter_;
  size_t sensors_;
  size_t widest_;
  CellPrices prices_;
  double dear_step_ = 0;         // first step of a search for a better price of dear slots
  std::vector<size_t> offsets_;  // by slot
  // By place, sensor and AoI:
  size_t entries_ = 0;
  std::unique_ptr<float[]> backward_;  // least cost of slots t..T
  std::unique_ptr<float[]> forward_;   // least cost of slots 1..t-1 of a flight that arrives there with that
                                       // AoI
  std::vector<float> own_cost_;        // cost of one slot, by sensor and AoI
  // For the place that is being worked on:
  std::vector<float> best_next_;      // by sensor and AoI in the next slot
  std::vector<float> pushed_;         // by sensor and AoI in the next slot
  std::vector<float> past_;           // of one sensor, by AoI
  std::vector<Marginals> marginals_;  // by sensor
};

}  // namespace fresco
