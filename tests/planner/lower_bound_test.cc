// Lower bounds and dominance against the exact cost of every situation that a tiny scenario's flights come
// to, with tables of all sizes.
#include "planner/lower_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "planner/dominance.h"
#include "planner/price_ascent.h"
#include "tests/planner/exhaustive_search.h"

namespace fresco {
namespace {

// A situation as the planner sees it: the sensors that count, whole weights, dear slots.
struct Seen {
  int cell = 0;
  int dear = 0;
  std::vector<int16_t> aoi;
};

class TinyProblem {
 public:
  explicit TinyProblem(const Scenario& scenario) : world_(scenario), problem_(world_), exhaustive_(scenario) {
    const int first = problem_.sensors()[0];
    units_per_weight_ =
        static_cast<double>(problem_.weights()[0]) / scenario.sensors[static_cast<size_t>(first)].weight;
    TakeSituations();
  }

  const PlannerProblem& problem() const { return problem_; }
  ExhaustiveSearch& exhaustive() { return exhaustive_; }
  /// Of one slot, all from which some flight arrives, up to a few hundred of them.
  const std::vector<Situation>& At(int slot) const { return situations_[static_cast<size_t>(slot)]; }

  Seen See(const Situation& situation) const {
    Seen seen;
    seen.cell = world_.CellIndex(situation.cell);
    const int moves = situation.slot - 1;
    seen.dear = problem_.IsDear(Move::kHover) ? situation.hovers : moves - situation.hovers;
    for (const int sensor : problem_.sensors()) {
      seen.aoi.push_back(static_cast<int16_t>(situation.aoi[static_cast<size_t>(sensor)]));
    }
    return seen;
  }

  /// In the planner's whole units; nothing where no flight arrives.
  double CostToGo(const Situation& situation, int unserved = 0, int unserved_slots = 0) {
    const double cost = exhaustive_.CostToGo(situation, unserved, unserved_slots) * units_per_weight_;
    return std::isfinite(cost) ? std::round(cost) : cost;
  }

 private:
  void TakeSituations() {
    constexpr size_t kMost = 300;
    situations_.resize(static_cast<size_t>(problem_.slots()) + 1);
    situations_[1] = {exhaustive_.Start()};
    for (int slot = 1; slot < problem_.slots(); ++slot) {
      std::map<std::tuple<int, int, int, std::vector<int>>, Situation> next;
      for (const Situation& situation : At(slot)) {
        for (const Situation& after : exhaustive_.Next(situation)) {
          if (next.size() < kMost && std::isfinite(exhaustive_.CostToGo(after))) {
            next[{after.cell.column, after.cell.row, after.hovers, after.aoi}] = after;
          }
        }
      }
      for (const auto& [key, situation] : next) {
        situations_[static_cast<size_t>(slot) + 1].push_back(situation);
      }
    }
  }

  UavWorld world_;
  PlannerProblem problem_;
  ExhaustiveSearch exhaustive_;
  double units_per_weight_ = 1;
  std::vector<std::vector<Situation>> situations_;
};

WorkMeter Unstopped() {
  return WorkMeter([](const SearchProgress&) { return true; });
}

TEST(LowerBound, IsNeverAboveTheLeastCostFromAnySituationOn) {
  WorkMeter meter = Unstopped();
  int compared = 0;
  int tight = 0;
  int without_tables = 0;
  for (uint32_t index = 0; index < 120; ++index) {
    SCOPED_TRACE(index);
    TinyProblem tiny(TinyScenario(index));
    for (const int64_t bytes : {0, 4096, 8192, 16384, 1 << 24}) {
      const LowerBound bound(tiny.problem(), bytes, meter);
      without_tables += !bound.has_tables();
      EXPECT_LE(bound.bytes(), bytes);
      for (int slot = 1; slot <= tiny.problem().slots(); ++slot) {
        for (const Situation& situation : tiny.At(slot)) {
          const Seen seen = tiny.See(situation);
          const int64_t least = LowerBound::OverCell(bound, slot, seen.cell)(seen.aoi.data(), seen.dear);
          const double exact = tiny.CostToGo(situation);
          ASSERT_LE(static_cast<double>(least), exact);
          ++compared;
          tight += static_cast<double>(least) == exact && bytes > 1 << 20;
        }
      }
    }
  }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(without_tables, 120);
  EXPECT_GT(tight, compared / 5 / 4);  // of those with full tables a quarter is exact
}

TEST(LowerBound, IsExactForASingleSensorWithEnergyEnough) {
  WorkMeter meter = Unstopped();
  int compared = 0;
  for (uint32_t index = 0; index < 200; ++index) {
    Scenario scenario = TinyScenario(index);
    scenario.sensors.resize(1);
    if (EnergyBinds(scenario)) {
      continue;
    }
    SCOPED_TRACE(index);
    TinyProblem tiny(scenario);
    const LowerBound bound(tiny.problem(), 1 << 24, meter);
    EXPECT_EQ(static_cast<double>(bound.OfAnyFlight()), tiny.CostToGo(tiny.At(1)[0]));
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

// Whatever flight below a limit goes on from a situation serves a sensor by then.
TEST(LowerBound, LongestUnservedCoversEveryFlightBelowTheLimit) {
  WorkMeter meter = Unstopped();
  int compared = 0;
  int shortened = 0;
  for (uint32_t index = 0; index < 120; ++index) {
    SCOPED_TRACE(index);
    TinyProblem tiny(TinyScenario(index));
    const PlannerProblem& problem = tiny.problem();
    if (problem.maximum_aoi() == 1) {
      continue;  // served or not is the same
    }
    const LowerBound bound(problem, index % 4 == 0 ? 8192 : 1 << 24, meter);
    for (int slot = 1; slot < problem.slots(); ++slot) {
      const std::vector<Situation>& situations = tiny.At(slot);
      for (size_t i = 0; i < situations.size(); i += 1 + situations.size() / 20) {
        const Seen seen = tiny.See(situations[i]);
        LowerBound::OverCell over_cell(bound, slot, seen.cell);
        over_cell(seen.aoi.data(), seen.dear);
        const int slots_left = problem.slots() - slot + 1;
        for (const int64_t excess : {1, 5, 20}) {
          const auto limit = static_cast<int64_t>(tiny.CostToGo(situations[i])) + excess;
          for (int n = 0; n < problem.size(); ++n) {
            const int longest = over_cell.LongestUnserved(n, seen.aoi[static_cast<size_t>(n)], limit);
            shortened += longest < slots_left;
            // Growing in one slot more than the longest: unserved in as many slots as the longest, slot T
            // serving nobody.
            ++compared;
            if (longest < slots_left) {
              const int unserved_slots = std::min(longest, slots_left - 1);
              const double cost =
                  tiny.CostToGo(situations[i], problem.sensors()[static_cast<size_t>(n)], unserved_slots);
              ASSERT_GE(cost, static_cast<double>(limit)) << "sensor " << n << ", longest " << longest;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 5000);
  EXPECT_GT(shortened, 500);
}

// Whether a label with A's situation and no cost so far beats one over the same cell with B's, and
// `cost_b` so far, in a search for flights below `limit`.
bool Beats(const PlannerProblem& problem, const LowerBound& bound, const Dominance& dominance, int slot,
           const Seen& a, const Seen& b, int64_t cost_b, int64_t limit) {
  LowerBound::OverCell over_cell(bound, slot, b.cell);
  over_cell(b.aoi.data(), b.dear);
  std::vector<double> gaps;
  for (size_t n = 0; n < b.aoi.size(); ++n) {
    const int longest = over_cell.LongestUnserved(static_cast<int>(n), b.aoi[n], limit - cost_b);
    gaps.push_back(static_cast<double>(problem.weights()[n]) * (longest - dominance.shortest_unserved(n)));
  }
  Undominated undominated(b.aoi.size(), problem.energy_binds());
  undominated.Add(dominance.LeastCost(0, a.aoi.data()), a.dear, a.aoi.data());
  return undominated.Beat(dominance.LeastCost(cost_b, b.aoi.data()), b.dear, b.aoi.data(), gaps.data());
}

// Where a label is beaten, its flights cost no less than those of the label that beats it, or than the
// limit.
TEST(Dominance, OnlyLetsLabelsBeatThoseThatLeadToNothingBetter) {
  WorkMeter meter = Unstopped();
  int beaten = 0;
  int unbeaten = 0;
  for (uint32_t index = 0; index < 120; ++index) {
    SCOPED_TRACE(index);
    TinyProblem tiny(TinyScenario(index));
    const PlannerProblem& problem = tiny.problem();
    const LowerBound bound(problem, 1 << 24, meter);
    const CoverageDistances distances(problem, meter);
    for (int slot = 2; slot < problem.slots(); ++slot) {
      const std::vector<Situation>& situations = tiny.At(slot);
      const size_t step = 1 + situations.size() / 30;
      for (size_t i = 0; i < situations.size() * situations.size(); i += step * step) {
        const Situation& a = situations[i / situations.size()];
        const Situation& b = situations[i % situations.size()];
        if (!(a.cell == b.cell)) {
          continue;
        }
        const Seen seen_a = tiny.See(a);
        const Seen seen_b = tiny.See(b);
        const Dominance dominance(problem, distances, slot, seen_b.cell);
        for (const int64_t cost_b : {-4, -2, 0, 3, 8}) {
          const auto least_b = static_cast<int64_t>(tiny.CostToGo(b)) + cost_b;
          const int64_t limit = least_b + 1 + static_cast<int64_t>(i % 7);
          if (Beats(problem, bound, dominance, slot, seen_a, seen_b, cost_b, limit)) {
            ASSERT_LE(tiny.CostToGo(a), static_cast<double>(least_b));
            ++beaten;
          } else {
            ++unbeaten;
          }
        }
      }
    }
  }
  EXPECT_GT(beaten, 10000);
  EXPECT_GT(unbeaten, 10000);
}

TEST(PriceAscent, RaisesTheBoundAtPricesThatSumToNothing) {
  WorkMeter meter = Unstopped();
  double unpriced = 0;
  double priced = 0;
  for (uint32_t index = 0; index < 60; ++index) {
    SCOPED_TRACE(index);
    const UavWorld world(TinyScenario(index));
    const PlannerProblem problem(world);
    const SlotCells slot_cells(problem, meter);
    PriceAscent ascent(problem, slot_cells, problem.maximum_aoi(), meter);
    ascent.Run();
    const CellPrices& prices = ascent.prices();
    const auto sensors = static_cast<size_t>(problem.size());
    EXPECT_GE(prices.dear_slot, 0);
    for (size_t place = 0; place < slot_cells.places(); ++place) {
      double sum = prices.transmission[place];
      EXPECT_GE(prices.transmission[place], 0);
      for (size_t n = 0; n < sensors; ++n) {
        sum += prices.presence[place * sensors + n];
      }
      ASSERT_NEAR(sum, 0, 1e-3);
    }
    // The bound is exact about what one sensor alone costs at most, all sensors together at least.
    WholePrices none{std::vector<int32_t>(prices.presence.size()),
                     std::vector<int32_t>(prices.transmission.size())};
    int64_t alone = 0;
    for (int sensor = 0; sensor < problem.size(); ++sensor) {
      const auto weight = static_cast<int32_t>(problem.weights()[static_cast<size_t>(sensor)]);
      const CostToGo table(problem, slot_cells, none, {sensor, weight, problem.maximum_aoi(), 1}, meter);
      alone += table.PlaceOf(1, 0).At(1);
    }
    const LowerBound bound(problem, 1 << 24, meter);
    EXPECT_GE(bound.OfAnyFlight(), alone - 1);  // but for the prices' rounding
    unpriced += static_cast<double>(alone);
    priced += static_cast<double>(bound.OfAnyFlight());
  }
  EXPECT_GT(priced, 1.05 * unpriced);
}

}  // namespace
}  // namespace fresco
