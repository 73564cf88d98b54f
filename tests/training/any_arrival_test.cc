// The weights of a whole run, whatever the sizes of the parts in which results arrive, in whichever order,
// twice, and with lies among them.
#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "tests/training/literal_run.h"
#include "training/ledger.h"

namespace fresco {
namespace {

/// The learner's ledger and trainer, and parts of results on their way to them.
class PostalRun {
 public:
  PostalRun(const Experiment& experiment, uint32_t number)
      : experiment_(experiment),
        ledger_(experiment_.world()),
        stream_(1, RandomPurpose::kTest, number, 0),
        trainer_(experiment_,
                 {[this](const Order& order) { ledger_.Write(order), ordered_.push_back(order); },
                  [this](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
                    versions_[version] = std::move(parameters);
                  },
                  [](const Evaluation&) {},
                  {}}) {}

  RunResult Finish() {
    trainer_.Begin();
    while (!trainer_.finished()) {
      for (const Order& order : std::exchange(ordered_, {})) {
        results_[order.index] =
            FlyOrder(experiment_, order, versions_.at({NetworkKind::kCurrent, order.current_version}),
                     versions_.at({NetworkKind::kTarget, order.target_version}));
        Post(order.index);
      }
      if (on_their_way_.empty()) {
        ADD_FAILURE() << "everything has arrived, and no order is complete";
        break;
      }
      Deliver();
      while (auto next = ledger_.TakeNext()) {
        trainer_.Commit(next->order, next->episode);
      }
    }
    return {trainer_.current(), trainer_.progress().updates, 0, trainer_.best()->evaluation.score(),
            trainer_.delivered() ? std::optional(trainer_.delivered()->score()) : std::nullopt};
  }

  int refused() const { return refused_; }

 private:
  uint32_t Below(int bound) { return stream_.NextBelow(static_cast<uint32_t>(bound)); }

  /// Sends a result in parts of any length, some of them twice, now and then with a lie beside them.
  void Post(int64_t index) {
    const OrderResult& result = results_.at(index);
    const int transitions = result.episode.transitions();
    for (int first = 0; first < transitions;) {
      const int count = 1 + static_cast<int>(Below(transitions - first));
      for (uint32_t copies = 1 + Below(2); copies > 0; --copies) {
        on_their_way_.push_back(PartOf(experiment_.world(), result, first, count));
      }
      first += count;
    }
    if (Below(4) == 0) {
      OrderResult lie = PartOf(experiment_.world(), result, 0, 1 + static_cast<int>(Below(transitions)));
      Below(2) == 0 ? ++lie.seed : static_cast<uint64_t>(lie.episode.rewards[0] += 1);
      on_their_way_.push_back(lie);
    }
  }

  void Deliver() {
    std::swap(on_their_way_[Below(static_cast<int>(on_their_way_.size()))], on_their_way_.back());
    const OrderResult part = std::move(on_their_way_.back());
    on_their_way_.pop_back();
    if (ledger_.Add(part) == Ledger::Arrival::kInconsistent) {
      ++refused_;
      Post(part.order_index);
    }
  }

  Experiment experiment_;
  Ledger ledger_;
  RandomStream stream_;
  Trainer trainer_;
  std::vector<Order> ordered_;  // and not flown yet
  std::map<NetworkVersion, std::shared_ptr<const Vector>> versions_;
  std::map<int64_t, OrderResult> results_;
  std::vector<OrderResult> on_their_way_;
  int refused_ = 0;
};

void ExpectTheSameWeightsInAnyOrderOfArrival(const Experiment& experiment) {
  const RunResult expected = RunInOneLoop(experiment);
  for (uint32_t number = 0; number < 5; ++number) {
    PostalRun run(experiment, number);
    const RunResult result = run.Finish();
    EXPECT_TRUE(result.weights == expected.weights);
    EXPECT_EQ(result.updates, expected.updates);
    EXPECT_EQ(result.best_score, expected.best_score);
    EXPECT_EQ(result.delivered_score, expected.delivered_score);
    EXPECT_GT(run.refused(), 0);
  }
}

TEST(AnyArrival, GivesTheSameWeightsOverTheField) {
  ExpectTheSameWeightsInAnyOrderOfArrival(SmallExperiment());
}

TEST(AnyArrival, GivesTheSameWeightsInCartPole) {
  ExpectTheSameWeightsInAnyOrderOfArrival(SmallCartPole());
}

TEST(AnyArrival, GivesOtherWeightsInCartPoleForAnotherSeed) {
  EXPECT_FALSE(RunInOneLoop(SmallCartPole()).weights ==
               RunInOneLoop(SmallCartPole({{"schedule.seed", "6"}})).weights);
}

}  // namespace
}  // namespace fresco
