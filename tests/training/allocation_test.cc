// No heap use in the training loop once warm: every allocation of this program is counted, so it is
// a program of its own.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/support/allocation_count.h"
#include "training/dqn.h"
#include "training/replay_memory.h"

#ifndef FRESCO_SANITIZED

namespace fresco {
namespace {

constexpr int kInputs = 7;
constexpr int kActions = 20;
constexpr int kBatch = 200;

class TrainingAllocations : public ::testing::Test {
 protected:
  TrainingAllocations()
      : memory_(kInputs, kActions, 500),
        batch_(kInputs, kActions, kBatch),
        observation_(kInputs, 0.5f),
        mask_(3, 0xff) {}

  void Insert() { memory_.Insert({observation_, observation_, 3, -1, false, mask_}); }
  void Sample(uint32_t update) {
    RandomStream stream(1, RandomPurpose::kReplaySampling, update, 0);
    memory_.Sample(stream, batch_);
  }

  ReplayMemory memory_;
  MiniBatch batch_;
  std::vector<float> observation_;
  std::vector<uint8_t> mask_;
};

TEST_F(TrainingAllocations, AreSeenByThisTest) {
  const int64_t before = AllocationCount();
  const auto batch = std::make_unique<MiniBatch>(kInputs, kActions, kBatch);
  EXPECT_GE(AllocationCount() - before, 7);
}

TEST_F(TrainingAllocations, DoNotHappenInTheReplayMemoryFromTheFirstTransitionOn) {
  const int64_t before = AllocationCount();
  for (uint32_t i = 0; i < 1200; ++i) {
    Insert();
    Sample(i);
  }
  EXPECT_EQ(AllocationCount(), before);
}

TEST_F(TrainingAllocations, DoNotHappenInUpdatesAndTargetCopiesOnceWarm) {
  for (const bool double_dqn : {false, true}) {
    const MlpShape shape({kInputs, 200, 256, kActions});
    DqnOptions options;
    options.double_dqn = double_dqn;
    options.batch_size = kBatch;
    Dqn dqn(shape, InitialParameters(shape, 1), options);
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

}  // namespace
}  // namespace fresco

#endif
