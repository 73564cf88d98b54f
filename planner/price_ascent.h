// Prices that make sensors agree. Flown for alone, every sensor would have the UAV to itself, and the sum
// of such optima is a weak lower bound. So each sensor pays a price (negative: is paid) where the UAV is,
// and one for transmitting there; as the prices of all sensors add up to nothing in every flight, the sum of
// the optima at these prices is a lower bound as well (Lagrangian decomposition). The ascent looks
// for prices that make it large: slot by slot, back and forth, it sets them so that being over a cell costs
// every sensor the same in its best flight through it (min-marginal averaging, as TRW-S does for
// graphical models); no step lowers the bound. One thread; deterministic.
//
// Reference: V. Kolmogorov, "Convergent tree-reweighted message passing for energy minimization", IEEE
// TPAMI 28(10), 2006.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "planner/slot_cells.h"

namespace fresco {

/// In units of cost. Floating point, so to be rounded to whole numbers before anything is proved by them.
struct CellPrices {
  /// For being there, by place (SlotCells) and sensor: [places x sensors]. In every place their sum and
  /// `transmission` make zero.
  std::vector<float> presence;
  std::vector<float> transmission;  ///< for being served there, by place; at least zero
  double dear_slot = 0;             ///< of every dear slot; each sensor pays its equal share
};

class PriceAscent {
 public:
  /// AoI beyond `aoi_limit` count as it. Both references must outlive the ascent.
  PriceAscent(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit, WorkMeter& meter);

  /// Until the bound rises but slowly, or the meter stops.
  void Run();

  const CellPrices& prices() const { return prices_; }

  static int64_t Bytes(const PlannerProblem& problem, const SlotCells& slot_cells, int aoi_limit);

 private:
  /// Of a sensor's flights through a place.
  struct Marginals {
    float unserved = 0;  ///< least cost, not served there
    float gain = 0;      ///< how much less it is when served there; at least zero
  };

  int Width(int slot) const;
  size_t Offset(int slot, size_t number) const;
  /// The bound at the present dear price, prices of places as they are.
  double Evaluate();
  void ImproveDearPrice();
  void SweepBackward(bool reprice);
  void SweepForward();
  void TakeBestNext(int slot, int cell);
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
  double dear_step_ = 0;         // the first one of a search for a better price
  std::vector<size_t> offsets_;  // by slot
  // By place, sensor and AoI:
  size_t entries_ = 0;
  std::unique_ptr<float[]> backward_;  // least cost of slots t..T, the slot's own included
  std::unique_ptr<float[]> forward_;   // least cost of slots 1..t-1 for coming there with that AoI
  std::vector<float> own_cost_;        // of a slot, by sensor and AoI
  // Of the place in work:
  std::vector<float> best_next_;      // by sensor and AoI in the next slot
  std::vector<float> pushed_;         // likewise
  std::vector<float> past_;           // of one sensor, by AoI
  std::vector<Marginals> marginals_;  // by sensor
};

}  // namespace fresco
