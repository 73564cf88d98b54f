// One sensor's table at random prices against a literal recursion, and the units of tables.
#include "planner/cost_to_go.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/planner/exhaustive_search.h"
#include "tests/worlds/test_scenarios.h"

namespace fresco {
namespace {

TEST(TableUnits, NeverSayMoreOfACostThanTheTablesDo) {
  for (const int shift : {-3, -1, 0, 2, 6}) {
    const TableUnits units{shift};
    const double unit = std::ldexp(1.0, shift);
    for (int64_t value = -200; value <= 200; ++value) {
      // A whole cost is not below value / unit iff it is not below this:
      EXPECT_EQ(units.CostOf(value), static_cast<int64_t>(std::ceil(static_cast<double>(value) / unit)));
      EXPECT_LE(static_cast<double>(units.Weight(std::abs(value))),
                static_cast<double>(std::abs(value)) * unit);
      EXPECT_GE(units.CostOf(units.ValueOf(value)), value);
      EXPECT_LT(units.CostOf(units.ValueOf(value) - 1), value);
    }
  }
}

class LiteralCostToGo {
 public:
  LiteralCostToGo(const PlannerProblem& problem, const SlotCells& slot_cells, const WholePrices& prices,
                  const CostToGoOptions& options)
      : problem_(problem), slot_cells_(slot_cells), prices_(prices), options_(options) {}

  int64_t Of(int slot, int cell, int aoi) const {
    const size_t place = slot_cells_.FirstPlace(slot) + static_cast<size_t>(slot_cells_.Number(slot, cell));
    const int64_t now =
        int64_t{options_.weight} * aoi +
        prices_.presence[place * static_cast<size_t>(problem_.size()) + static_cast<size_t>(options_.sensor)];
    if (slot == problem_.slots()) {
      return now;
    }
    const int grown = std::min(aoi + 1, options_.aoi_limit);
    int64_t later = std::numeric_limits<int64_t>::max();
    for (const Move move : kAllMoves) {
      const int after = problem_.After(cell, move);
      if (after < 0 || slot_cells_.Number(slot + 1, after) < 0) {
        continue;
      }
      const int64_t price = problem_.IsDear(move) ? prices_.dear_share : 0;
      later = std::min(later, price + Of(slot + 1, after, grown));
      if (problem_.Covers(cell, options_.sensor)) {
        later = std::min(later, price + prices_.transmission[place] + Of(slot + 1, after, 1));
      }
    }
    return now + later;
  }

 private:
  const PlannerProblem& problem_;
  const SlotCells& slot_cells_;
  const WholePrices& prices_;
  CostToGoOptions options_;
};

WholePrices RandomPrices(const PlannerProblem& problem, const SlotCells& slot_cells, uint32_t index) {
  RandomStream stream = TestStream(22, index);
  WholePrices prices;
  for (size_t i = 0; i < slot_cells.places() * static_cast<size_t>(problem.size()); ++i) {
    prices.presence.push_back(static_cast<int32_t>(stream.NextBelow(21)) - 10);
  }
  for (size_t i = 0; i < slot_cells.places(); ++i) {
    prices.transmission.push_back(static_cast<int32_t>(stream.NextBelow(8)));
  }
  prices.dear_share = static_cast<int32_t>(stream.NextBelow(5));
  return prices;
}

TEST(CostToGo, IsTheLeastCostOfAllFlightsForOneSensor) {
  WorkMeter meter([](const SearchProgress&) { return true; });
  int compared = 0;
  for (uint32_t index = 0; index < 150; ++index) {
    SCOPED_TRACE(index);
    Scenario scenario = TinyScenario(index);
    if (scenario.slots > 6) {
      continue;
    }
    const UavWorld world(scenario);
    const PlannerProblem problem(world);
    const SlotCells slot_cells(problem, meter);
    const WholePrices prices = RandomPrices(problem, slot_cells, index);
    const int aoi_limit = index % 3 == 0 ? 2 : problem.maximum_aoi();
    const CostToGoOptions options{problem.size() - 1, 3, aoi_limit, index % 2 == 0 ? 1 : -4};
    const CostToGo table(problem, slot_cells, prices, options, meter);
    const LiteralCostToGo literal(problem, slot_cells, prices, options);
    for (int slot = 1; slot <= problem.slots(); ++slot) {
      for (const int32_t cell : slot_cells.At(slot)) {
        const CostToGo::Place place = table.PlaceOf(slot, slot_cells.Number(slot, cell));
        for (int aoi = options.lowest_aoi; aoi <= slot; ++aoi) {
          ASSERT_EQ(place.At(aoi), literal.Of(slot, cell, std::min(aoi, aoi_limit)));
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 2000);
}

}  // namespace
}  // namespace fresco
