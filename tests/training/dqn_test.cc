// One update of the DQN against a slow literal version in double precision: targets by loops,
// gradients by central finite differences of the loss, Adam's first step by its definition. No heap use in
// the training loop once warm: every allocation of this program is counted.
#include "training/dqn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "nn/mlp.h"
#include "nn/set_network.h"
#include "tests/nn/literal_network.h"
#include "tests/support/allocation_count.h"
#include "training/replay_memory.h"

namespace fresco {
namespace {

const std::vector<int> kLayers = {3, 6, 4};
constexpr int kBatch = 8;

Doubles Forward(const Doubles& parameters, const Matrix& inputs, int column) {
  const float* first = inputs.col(column).data();
  return LiteralForward(kLayers, parameters, Doubles(first, first + inputs.rows()));
}

double LiteralTarget(const Doubles& current, const Doubles& target, const MiniBatch& batch, int column,
                     bool double_dqn) {
  const auto i = static_cast<size_t>(column);
  const double least = static_cast<double>(batch.least_values[i]);
  if (batch.discounts[i] == 0) {
    return std::max(least, static_cast<double>(batch.rewards[i]));
  }
  const Doubles values = Forward(target, batch.next_observations, column);
  const Doubles choosing = double_dqn ? Forward(current, batch.next_observations, column) : values;
  int best = -1;
  for (int action = 0; action < kLayers.back(); ++action) {
    const bool allowed = batch.next_mask(column)[static_cast<size_t>(action)] != 0;
    if (allowed &&
        (best < 0 || choosing[static_cast<size_t>(action)] > choosing[static_cast<size_t>(best)])) {
      best = action;
    }
  }
  return std::max(least, static_cast<double>(batch.rewards[i]) +
                             static_cast<double>(batch.discounts[i]) * values[static_cast<size_t>(best)]);
}

double LiteralLoss(const Doubles& parameters, const Doubles& targets, const MiniBatch& batch) {
  double loss = 0;
  for (int column = 0; column < kBatch; ++column) {
    const auto i = static_cast<size_t>(column);
    const double error =
        targets[i] - Forward(parameters, batch.observations, column)[static_cast<size_t>(batch.actions[i])];
    loss += error * error;
  }
  return loss / kBatch;
}

MiniBatch RandomBatch(RandomStream& stream) {
  MiniBatch batch(kLayers.front(), kLayers.back(), kBatch);
  for (int column = 0; column < kBatch; ++column) {
    const auto i = static_cast<size_t>(column);
    for (int row = 0; row < kLayers.front(); ++row) {
      batch.observations(row, column) = static_cast<float>(stream.NextUniform());
      batch.next_observations(row, column) = static_cast<float>(stream.NextUniform());
    }
    batch.actions[i] = static_cast<int16_t>(stream.NextBelow(4));
    batch.rewards[i] = static_cast<float>(-stream.NextUniform());
    batch.discounts[i] = column == 2 ? 0.0f : 0.9f / static_cast<float>(1 + column % 2);
    if (column % 3 == 0) {  // one that never decides, one that always does, one in between
      batch.least_values[i] = static_cast<float>(column) - 3;
    }
    const auto allowed = static_cast<int>(stream.NextBelow(4));
    for (int action = 0; action < 4; ++action) {
      const bool is_allowed = action == allowed || stream.NextBelow(2) == 0;
      batch.next_masks[i * 4 + static_cast<size_t>(action)] = is_allowed ? 1 : 0;
    }
  }
  return batch;
}

Doubles ToDoubles(const Vector& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

class DqnTest : public ::testing::TestWithParam<bool> {
 protected:
  DqnTest()
      : stream_(GetParam() ? 1 : 2, RandomPurpose::kTest, 0, 0),
        dqn_(network_, network_->InitialParameters(3), Options()) {}
  static DqnOptions Options() {
    DqnOptions options;
    options.double_dqn = GetParam();
    options.batch_size = kBatch;
    return options;
  }
  RandomStream stream_;
  std::shared_ptr<const Network> network_ = std::make_shared<Mlp>(MlpShape(kLayers));
  Dqn dqn_;
};

TEST_P(DqnTest, UpdatesAsTheLiteralVersionDoes) {
  for (int warm_up = 0; warm_up < 20; ++warm_up) {  // so that current and target differ
    dqn_.Update(RandomBatch(stream_), 1e-2);
  }
  Dqn fresh(network_, dqn_.current(), Options());
  const MiniBatch batch = RandomBatch(stream_);
  fresh.CopyToTarget();
  fresh.Update(RandomBatch(stream_), 1e-2);  // current moves away from target
  const Doubles current = ToDoubles(fresh.current());
  const Doubles target = ToDoubles(fresh.target());
  Doubles targets;
  for (int column = 0; column < kBatch; ++column) {
    targets.push_back(LiteralTarget(current, target, batch, column, GetParam()));
  }
  const double loss = fresh.Update(batch, 1e-3);
  EXPECT_NEAR(loss, LiteralLoss(current, targets, batch), 1e-5);
  // The step goes down the literal loss, in the way that its gradient and Adam's moments say.
  EXPECT_LT(LiteralLoss(ToDoubles(fresh.current()), targets, batch),
            LiteralLoss(current, targets, batch) + 1e-3);
  EXPECT_EQ(ToDoubles(fresh.target()), target);
}

TEST_P(DqnTest, FirstStepFollowsTheSignOfTheLiteralGradient) {
  const MiniBatch batch = RandomBatch(stream_);
  const Doubles before = ToDoubles(dqn_.current());
  Doubles targets;
  for (int column = 0; column < kBatch; ++column) {
    targets.push_back(LiteralTarget(before, before, batch, column, GetParam()));
  }
  constexpr double kLearningRate = 1e-3;
  dqn_.Update(batch, kLearningRate);
  const Doubles after = ToDoubles(dqn_.current());
  constexpr double kStep = 1e-6;
  for (size_t i = 0; i < before.size(); ++i) {
    Doubles shifted = before;
    shifted[i] += kStep;
    const double above = LiteralLoss(shifted, targets, batch);
    shifted[i] -= 2 * kStep;
    const double gradient = (above - LiteralLoss(shifted, targets, batch)) / (2 * kStep);
    // Adam's first step: learning rate * g / (|g| + epsilon).
    const double expected = before[i] - kLearningRate * gradient / (std::abs(gradient) + 1e-8);
    if (std::abs(gradient) > 1e-5 || gradient == 0) {
      EXPECT_NEAR(after[i], expected, 2e-6) << i;
    }
  }
}

TEST_P(DqnTest, LearnsAFixedBatch) {
  MiniBatch batch = RandomBatch(stream_);
  std::fill(batch.discounts.begin(), batch.discounts.end(), 0.0f);
  const double first = dqn_.Update(batch, 1e-2);
  double last = first;
  for (int i = 0; i < 2000; ++i) {
    last = dqn_.Update(batch, 1e-2);
  }
  EXPECT_LT(last, first / 100);
}

TEST_P(DqnTest, TargetChangesOnlyWhenItIsCopied) {
  const Vector target = dqn_.target();
  dqn_.Update(RandomBatch(stream_), 1e-2);
  EXPECT_EQ(dqn_.target(), target);
  EXPECT_NE(dqn_.current(), target);
  dqn_.CopyToTarget();
  EXPECT_EQ(dqn_.target(), dqn_.current());
}

INSTANTIATE_TEST_SUITE_P(PlainAndDouble, DqnTest, ::testing::Bool());

/// A batch of random transitions with all actions allowed.
MiniBatch WideBatch(int inputs, int actions, int size, RandomStream& stream) {
  MiniBatch batch(inputs, actions, size);
  for (int column = 0; column < size; ++column) {
    for (int row = 0; row < inputs; ++row) {
      batch.observations(row, column) = static_cast<float>(stream.NextUniform());
      batch.next_observations(row, column) = static_cast<float>(stream.NextUniform());
    }
    const auto i = static_cast<size_t>(column);
    batch.actions[i] = static_cast<int16_t>(stream.NextBelow(static_cast<uint32_t>(actions)));
    batch.rewards[i] = static_cast<float>(-stream.NextUniform());
    batch.discounts[i] = stream.NextBelow(10) == 0 ? 0 : 1;
  }
  std::fill(batch.next_masks.begin(), batch.next_masks.end(), uint8_t{1});
  return batch;
}

/// Networks with 7 inputs and 20 outputs.
class DqnOfNetworks : public ::testing::TestWithParam<std::shared_ptr<const Network>> {};

const auto kNetworks =
    ::testing::Values(std::make_shared<const Mlp>(MlpShape({7, 200, 256, 20})),
                      std::make_shared<const SetNetwork>(SetShape{1, 3, 2, 5, {64, 64}, {128, 128}, {64}}));
INSTANTIATE_TEST_SUITE_P(FlatAndSets, DqnOfNetworks, kNetworks);

TEST_P(DqnOfNetworks, ThreadsChangeNoBit) {
  const std::shared_ptr<const Network> network = GetParam();
  for (const int size : {200, 64, 33, 5}) {
    for (const bool double_dqn : {false, true}) {
      DqnOptions options;
      options.batch_size = size;
      options.double_dqn = double_dqn;
      std::optional<Vector> expected;
      for (const int threads : {1, 2, 3, 8}) {
        RandomStream stream(5, RandomPurpose::kTest, 0, 0);
        Dqn dqn(network, network->InitialParameters(1), options, threads);
        for (int update = 0; update < 6; ++update) {
          dqn.Update(WideBatch(7, 20, size, stream), 1e-3);
          if (update == 3) {
            dqn.CopyToTarget();
          }
        }
        if (!expected) {
          expected = dqn.current();
        }
        EXPECT_EQ(dqn.current(), *expected) << threads << " threads, batch " << size;
      }
    }
  }
}

#ifndef FRESCO_SANITIZED

class TrainingAllocations : public DqnOfNetworks {
 protected:
  static constexpr int kInputs = 7;
  static constexpr int kActions = 20;
  static constexpr int kBatch = 200;

  TrainingAllocations()
      : memory_(kInputs, kActions, 500),
        batch_(kInputs, kActions, kBatch),
        observation_(kInputs, 0.5f),
        mask_(3, 0xff) {}

  void Insert() { memory_.Insert({observation_, observation_, 3, -1, 1, mask_}); }
  void Sample(uint32_t update) {
    RandomStream stream(1, RandomPurpose::kReplaySampling, update, 0);
    memory_.Sample(stream, batch_);
  }

  ReplayMemory memory_;
  MiniBatch batch_;
  std::vector<float> observation_;
  std::vector<uint8_t> mask_;
};

INSTANTIATE_TEST_SUITE_P(FlatAndSets, TrainingAllocations, kNetworks);

TEST_P(TrainingAllocations, AreSeenByThisTest) {
  const int64_t before = AllocationCount();
  const auto batch = std::make_unique<MiniBatch>(kInputs, kActions, kBatch);
  EXPECT_GE(AllocationCount() - before, 7);
}

TEST_P(TrainingAllocations, DoNotHappenInTheReplayMemoryFromTheFirstTransitionOn) {
  const int64_t before = AllocationCount();
  for (uint32_t i = 0; i < 1200; ++i) {
    Insert();
    Sample(i);
  }
  EXPECT_EQ(AllocationCount(), before);
}

TEST_P(TrainingAllocations, DoNotHappenInUpdatesAndTargetCopiesOnceWarm) {
  for (const bool double_dqn : {false, true}) {
    const std::shared_ptr<const Network> network = GetParam();
    DqnOptions options;
    options.double_dqn = double_dqn;
    options.batch_size = kBatch;
    Dqn dqn(network, network->InitialParameters(1), options, 2);
    const auto update = [&](uint32_t index) {
      Insert();
      Sample(index);
      dqn.Update(batch_, 1e-3);
      dqn.CopyToTarget();
    };
    update(0);
    const int64_t before = AllocationCount();
    for (uint32_t index = 1; index < 6; ++index) {
      update(index);
    }
    EXPECT_EQ(AllocationCount(), before);
  }
}

#endif

}  // namespace
}  // namespace fresco
