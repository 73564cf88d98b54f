// Excursions: straight flights to random cells, of the share of the random choices that the schedule says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "core/random.h"
#include "tests/training/literal_flight.h"

namespace fresco {
namespace {

Experiment FieldWithExcursions(double share, const Settings& settings = {}) {
  Settings all = settings;
  all.emplace_back("schedule.excursion_share", std::to_string(share));
  return SmallField(all);
}

/// An action as a literal flyer would take it; nothing where either of two is a matter of rounding.
std::optional<int> LiteralChoice(const Doubles& values, const Mask& mask) {
  return Lead(values, mask) > kValueRounding ? std::optional(LiteralArgmax(values, mask)) : std::nullopt;
}

/// The mask with all moves but one left out.
Mask WithMove(const UavWorld& world, Mask mask, Move move) {
  for (int action = 0; action < world.actions(); ++action) {
    if (world.ActionAt(action).move != move) {
      mask[static_cast<size_t>(action)] = 0;
    }
  }
  return mask;
}

bool AnyAllowed(const Mask& mask) {
  return std::find(mask.begin(), mask.end(), 1) != mask.end();
}

class FlyerExcursions : public ::testing::TestWithParam<bool> {
 protected:
  Settings masks_ = GetParam() ? WithMasks() : Settings{};
};

/// The flyer's rule once more, slot by slot, with the draws that the order's key gives.
TEST_P(FlyerExcursions, FlyStraightToTheDrawnCellAndScheduleGreedily) {
  const Experiment experiment = FieldWithExcursions(0.6, masks_);
  const UavWorld& world = RequireUavWorld(experiment.world(), "the test");
  int flown_towards = 0;
  int cut_short = 0;
  for (int index = 0; index < 200; ++index) {
    const FlightPlan plan = PlanOf(experiment, index, 0.3);
    const Episode episode = FlyAlone(experiment, plan).episode;
    const auto masks = MasksOf(experiment, episode);
    std::optional<Cell> waypoint;
    for (size_t i = 0; i < episode.actions.size(); ++i) {
      const UavState state = StateIn(episode, i);
      const Doubles values = LiteralValues(experiment, *plan.current, state);
      RandomStream stream(plan.order.seed, RandomPurpose::kActing, static_cast<uint32_t>(state.slot), 0);
      if (waypoint && *waypoint == state.cell) {
        waypoint.reset();
      }
      Mask among = masks[i];
      if (!waypoint && stream.NextUniform() < 0.3) {
        if (stream.NextUniform() >= 0.6) {
          continue;  // one random action: see flyer_actions_test.cc
        }
        const int column = static_cast<int>(stream.NextBelow(5));
        const int row = static_cast<int>(stream.NextBelow(5));
        waypoint = Cell{column, row};
      }
      if (waypoint) {
        among = WithMove(world, masks[i], MoveTowards(state.cell, *waypoint));
        if (AnyAllowed(among)) {
          ++flown_towards;
        } else {
          ++cut_short;
          among = masks[i];
          waypoint.reset();
        }
      }
      const std::optional<int> expected = LiteralChoice(values, among);
      EXPECT_TRUE(!expected || episode.actions[i] == *expected) << index << ", " << i;
    }
  }
  EXPECT_GT(flown_towards, 500);
  EXPECT_EQ(cut_short > 0, GetParam());  // only a mask ends an excursion early
}

TEST_P(FlyerExcursions, LeadToEveryCellAlike) {
  const Experiment experiment = FieldWithExcursions(1, masks_);
  const UavWorld& world = RequireUavWorld(experiment.world(), "the test");
  // With epsilon 1 the first move is that of an excursion. From (0, 0), of the 25 cells, it is east to the 14
  // others with column >= row, north to the 10 with column < row, and a hover to (0, 0) itself.
  constexpr int kOrders = 4000;
  std::vector<FlightPlan> plans(kOrders, PlanOf(experiment, 0, 1));
  for (size_t index = 0; index < plans.size(); ++index) {
    plans[index].order = TrainOrder(static_cast<int64_t>(index), 1);
  }
  std::array<int, kMoves> moves{};
  for (const auto& [index, result] : FlyTogether(experiment, 64, plans, 64)) {
    ++moves.at(static_cast<size_t>(world.ActionAt(result.episode.actions[0]).move));
  }
  const auto expect_share = [&](Move move, double share) {
    EXPECT_NEAR(moves.at(static_cast<size_t>(move)), kOrders * share,
                kDeviations * std::sqrt(kOrders * share * (1 - share)));
  };
  expect_share(Move::kEast, 14 / 25.0);
  expect_share(Move::kNorth, 10 / 25.0);
  expect_share(Move::kHover, 1 / 25.0);
}

TEST_P(FlyerExcursions, GiveTheSameBitsInAnyCompany) {
  const Experiment experiment = FieldWithExcursions(0.5, masks_);
  std::vector<FlightPlan> plans;
  for (int index = 0; index < 40; ++index) {
    plans.push_back(PlanOf(experiment, index, (index % 5) / 4.0));
  }
  for (const int per_slot : {1, 3, 40}) {
    const auto together = FlyTogether(experiment, 40, plans, per_slot);
    for (const FlightPlan& plan : plans) {
      EXPECT_TRUE(SameBits(together.at(plan.order.index), FlyAlone(experiment, plan)));
    }
  }
}

TEST_P(FlyerExcursions, AreNoneWithEpsilonZero) {
  const Experiment with = FieldWithExcursions(1, masks_);
  const Experiment without = SmallField(masks_);
  for (uint32_t network = 0; network < 20; ++network) {
    const FlightPlan plan = PlanOf(with, 1, 0, network, network);
    EXPECT_TRUE(SameBits(FlyAlone(with, plan), FlyAlone(without, plan)));
  }
}

INSTANTIATE_TEST_SUITE_P(Masks, FlyerExcursions, ::testing::Bool());

}  // namespace
}  // namespace fresco
