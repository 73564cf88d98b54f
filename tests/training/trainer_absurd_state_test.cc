// States that no training comes to, as a file may hold them in spite of its CRC: refused in words, or gone on
// with to the end. Thousands of them, a few fields of a true state changed at random.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "tests/support/sanitized.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

/// The parameter says whether the world is CartPole or the field.
class AbsurdState : public ::testing::TestWithParam<bool> {
 protected:
  AbsurdState() {
    RecordedRun run(whole_.experiment);
    for (size_t committed = 0; committed < whole_.episodes.size(); ++committed) {
      if (committed % 9 == 0 || committed + 5 > whole_.episodes.size()) {
        states_.push_back(run.trainer.Save());
      }
      run.Commit(whole_.episodes[committed]);
    }
    states_.push_back(run.trainer.Save());
  }

  int64_t AbsurdNumber() {
    constexpr int64_t kNumbers[] = {std::numeric_limits<int64_t>::min(),
                                    std::numeric_limits<int64_t>::max(),
                                    std::numeric_limits<int32_t>::min(),
                                    std::numeric_limits<int32_t>::max(),
                                    -1,
                                    0,
                                    1,
                                    7,
                                    100,
                                    10'000};
    return kNumbers[stream_.NextBelow(std::size(kNumbers))];
  }

  /// Sets a number to an absurd one, or to one beside it.
  template <class Number>
  void Change(Number& number) {
    const auto beside = static_cast<uint64_t>(number) + (stream_.NextBelow(2) == 0 ? 1 : ~uint64_t{0});
    number = static_cast<Number>(stream_.NextBelow(2) == 0 ? AbsurdNumber() : static_cast<int64_t>(beside));
  }

  void ChangeProgress(TrainerProgress& progress) {
    int64_t* const counts[] = {&progress.committed_orders, &progress.episodes, &progress.transitions,
                               &progress.updates, &progress.replay_size};
    int32_t* const versions[] = {&progress.current_version, &progress.target_version};
    const uint32_t field = stream_.NextBelow(7);
    field < 5 ? Change(*counts[field]) : Change(*versions[field - 5]);
  }

  void ChangeOrders(std::vector<OrderInFlight>& orders) {
    if (orders.empty()) {
      orders.push_back({});
    }
    OrderInFlight& entry = orders[stream_.NextBelow(static_cast<uint32_t>(orders.size()))];
    switch (stream_.NextBelow(6)) {
      case 0:
        return Change(entry.order.index);
      case 1:
        return Change(entry.order.current_version);
      case 2:
        return Change(entry.order.target_version);
      case 3:
        return Change(entry.updates_at_writing);
      case 4:
        entry.order.kind = OrderKind::kEvaluate;
        return;
      default:
        orders.pop_back();
    }
  }

  /// Makes another episode of one that is in the replay memory, or leaves some out.
  void ChangeReplay(std::vector<std::shared_ptr<const Episode>>& replay) {
    if (replay.empty()) {
      replay.push_back(std::make_shared<const Episode>());
      return;
    }
    const uint32_t position = stream_.NextBelow(static_cast<uint32_t>(replay.size()));
    Episode episode = *replay[position];
    switch (stream_.NextBelow(6)) {
      case 0:
        replay.resize(position);
        return;
      case 1:
        replay.erase(replay.begin());
        return;
      case 2:
        Change(episode.actions[stream_.NextBelow(static_cast<uint32_t>(episode.actions.size()))]);
        break;
      case 3:
        episode.actions.resize(stream_.NextBelow(20));
        break;
      case 4:
        episode.states.resize(stream_.NextBelow(100));
        break;
      default:
        episode.ending = static_cast<Ending>(stream_.NextBelow(3));
    }
    replay[position] = std::make_shared<const Episode>(std::move(episode));
  }

  void ChangeEvaluations(TrainingState& state) {
    switch (stream_.NextBelow(5)) {
      case 0:
        return Change(state.partial_evaluation.episodes);
      case 1:
        return Change(state.partial_evaluation.successes);
      case 2:
        state.partial_evaluation.figures.resize(stream_.NextBelow(5));
        return;
      case 3:
        state.progress.delivering = !state.progress.delivering;
        return;
      default:
        state.best.reset();
    }
  }

  void ChangeOther(TrainingState& state) {
    switch (stream_.NextBelow(4)) {
      case 0:
        return Change(state.adam.steps);
      case 1:
        return ChangeReplay(state.replay);
      case 2:
        return ChangeEvaluations(state);
      default:
        return Change(
            state.versions[stream_.NextBelow(static_cast<uint32_t>(state.versions.size()))].version.number);
    }
  }

  void ChangeSomething(TrainingState& state) {
    switch (stream_.NextBelow(3)) {
      case 0:
        return ChangeProgress(state.progress);
      case 1:
        return ChangeOrders(state.orders);
      default:
        return ChangeOther(state);
    }
  }

  /// Goes on for some orders, with any episode that fits.
  void GoOn(Trainer& trainer, std::vector<Order>& orders) {
    constexpr size_t kOrders = 30;
    for (size_t next = 0; next < orders.size() && next < kOrders && !trainer.finished(); ++next) {
      trainer.Commit(Order(orders[next]), whole_.episodes[next]);
    }
  }

  const FinishedRun whole_{GetParam() ? SmallCartPole() : SmallExperiment()};
  std::vector<TrainingState> states_;
  RandomStream stream_{1, RandomPurpose::kTest, 0, 0};
};

TEST_P(AbsurdState, IsRefusedOrGoneOnWith) {
  constexpr int kTries = kSanitized ? 1000 : 4000;
  int refused = 0;
  for (int i = 0; i < kTries; ++i) {
    SCOPED_TRACE(i);
    TrainingState state = states_[stream_.NextBelow(static_cast<uint32_t>(states_.size()))];
    for (uint32_t changes = 1 + stream_.NextBelow(3); changes > 0; --changes) {
      ChangeSomething(state);
    }
    std::vector<Order> orders;
    Trainer trainer(whole_.experiment, {[&](const Order& order) { orders.push_back(order); },
                                        [](NetworkVersion, const std::shared_ptr<const Vector>&) {},
                                        [](const Evaluation&) {},
                                        {}});
    try {
      trainer.Resume(state);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    EXPECT_TRUE(trainer.finished() || !orders.empty()) << "nobody would ever fly";
    GoOn(trainer, orders);
  }
  EXPECT_GT(refused, kTries / 2);
  EXPECT_LT(refused, kTries);
}

INSTANTIATE_TEST_SUITE_P(Worlds, AbsurdState, ::testing::Bool(),
                         [](const auto& instance) { return instance.param ? "CartPole" : "Field"; });

}  // namespace
}  // namespace fresco
