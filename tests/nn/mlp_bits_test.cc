// An observation's output has the same bits whatever else is in its batch.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

using Bits = std::vector<uint32_t>;

Bits OutputBits(const MlpWorkspace& workspace, int column) {
  const Matrix& output = workspace.output();
  Bits bits(static_cast<size_t>(output.rows()));
  std::memcpy(bits.data(), output.col(column).data(), bits.size() * sizeof(uint32_t));
  return bits;
}

class MlpBits : public ::testing::TestWithParam<std::vector<int>> {
 protected:
  MlpBits() : mlp_(MlpShape(GetParam())), parameters_(InitialParameters(mlp_.shape(), 3)) {
    RandomStream stream(1, RandomPurpose::kTest, 0, 0);
    for (int i = 0; i < kObservations; ++i) {
      observations_.push_back(RandomFloats(stream, static_cast<size_t>(mlp_.shape().inputs()), 2));
      alone_.push_back(Forward({i}, 1, 0));
    }
  }

  /// Outputs of observation `members[place]` in a batch of these observations.
  Bits Forward(const std::vector<int>& members, int capacity, int place) {
    MlpWorkspace workspace(mlp_.shape(), capacity);
    // Rubbish in the columns beyond the batch must not matter.
    workspace.input().setConstant(std::numeric_limits<float>::quiet_NaN());
    for (size_t column = 0; column < members.size(); ++column) {
      SetColumn(workspace, static_cast<int>(column), observations_[static_cast<size_t>(members[column])]);
    }
    mlp_.Forward(SpanOf(parameters_), static_cast<int>(members.size()), workspace);
    return OutputBits(workspace, place);
  }

  static constexpr int kObservations = 300;
  Mlp mlp_;
  Vector parameters_;
  std::vector<std::vector<float>> observations_;
  std::vector<Bits> alone_;
};

TEST_P(MlpBits, AreThoseOfTheObservationAloneInBatchesOfEveryWidth) {
  std::vector<int> widths(130);
  std::iota(widths.begin(), widths.end(), 1);
  widths.insert(widths.end(), {199, 200, 256, 300});
  for (const int width : widths) {
    MlpWorkspace workspace(mlp_.shape(), width);
    for (int column = 0; column < width; ++column) {
      SetColumn(workspace, column, observations_[static_cast<size_t>(column)]);
    }
    mlp_.Forward(SpanOf(parameters_), width, workspace);
    for (int column = 0; column < width; ++column) {
      ASSERT_EQ(OutputBits(workspace, column), alone_[static_cast<size_t>(column)])
          << width << ", " << column;
    }
  }
}

TEST_P(MlpBits, DoNotDependOnTheColumnTheCompanyOrTheWorkspace) {
  RandomStream stream(2, RandomPurpose::kTest, 0, 0);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<int> members(1 + stream.NextBelow(40));
    for (int& member : members) {
      member = static_cast<int>(stream.NextBelow(kObservations));
    }
    const int place = static_cast<int>(stream.NextBelow(static_cast<uint32_t>(members.size())));
    const int capacity = static_cast<int>(members.size() + stream.NextBelow(100));
    EXPECT_EQ(Forward(members, capacity, place),
              alone_[static_cast<size_t>(members[static_cast<size_t>(place)])]);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MlpBits,
                         ::testing::Values(std::vector<int>{7, 200, 256, 20}, std::vector<int>{5, 64, 10},
                                           std::vector<int>{12, 33, 17, 9, 45}, std::vector<int>{20, 10},
                                           std::vector<int>{6, 1, 15}, std::vector<int>{104, 512, 300, 505}));

TEST(ArithmeticFingerprint, IsTheSameEveryTime) {
  EXPECT_EQ(ArithmeticFingerprint(), ArithmeticFingerprint());
  EXPECT_NE(ArithmeticFingerprint(), 0u);
}

}  // namespace
}  // namespace fresco
