// Forward against plain loops in double precision; gradients against central finite differences of them. An
// observation's output has the same bits whatever else is in its batch.
#include "nn/mlp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

constexpr int kBatch = 11;

class MlpGradient : public ::testing::TestWithParam<std::vector<int>> {
 protected:
  MlpGradient()
      : mlp_(MlpShape(GetParam())),
        parameters_(mlp_.InitialParameters(5)),
        workspace_(mlp_.shape(), kBatch, MlpWorkspace::Passes::kForwardAndBackward) {
    RandomStream stream(7, RandomPurpose::kTest, 0, 0);
    for (int layer = 0; layer < mlp_.shape().layers(); ++layer) {
      const auto biases = RandomFloats(stream, static_cast<size_t>(mlp_.shape().layer_outputs(layer)), 0.5);
      std::copy(biases.begin(), biases.end(), parameters_.data() + mlp_.shape().biases_offset(layer));
    }
    for (int column = 0; column < kBatch; ++column) {
      observations_.push_back(RandomFloats(stream, static_cast<size_t>(mlp_.shape().inputs()), 1));
      SetColumn(workspace_, column, observations_.back());
      units_.push_back(static_cast<int16_t>(stream.NextBelow(static_cast<uint32_t>(mlp_.shape().outputs()))));
    }
    values_ = RandomFloats(stream, kBatch, 1);
    doubles_.assign(parameters_.data(), parameters_.data() + parameters_.size());
    mlp_.Forward(Values(parameters_), {0, kBatch}, workspace_);
  }

  Doubles LiteralOutputs(int column) const {
    const auto& observation = observations_[static_cast<size_t>(column)];
    return LiteralForward(GetParam(), doubles_, Doubles(observation.begin(), observation.end()));
  }

  /// A loss that is linear in one output of each column, so that its gradient there is values_.
  double LiteralLoss() const {
    double loss = 0;
    for (size_t column = 0; column < kBatch; ++column) {
      loss += LiteralOutputs(static_cast<int>(column))[static_cast<size_t>(units_[column])] *
              static_cast<double>(values_[column]);
    }
    return loss;
  }

  /// A backward pass whose stages go through columns and parts in these steps, the last ones first.
  std::vector<float> Backward(int columns_at_once) {
    std::vector<float> gradient(static_cast<size_t>(parameters_.size()), 123.0f);
    const OutputGradient output_gradient{units_, values_};
    for (const ParameterPart& part : mlp_.parts()) {
      mlp_.Transpose(Values(parameters_), part, workspace_);
    }
    for (int end = kBatch; end > 0; end -= columns_at_once) {
      mlp_.BackwardColumns(output_gradient, {std::max(0, end - columns_at_once), end}, workspace_);
    }
    std::for_each(mlp_.parts().rbegin(), mlp_.parts().rend(), [&](const ParameterPart& part) {
      mlp_.BackwardPart(
          output_gradient, kBatch, part, workspace_,
          std::span(gradient).subspan(static_cast<size_t>(part.first), static_cast<size_t>(part.size())));
    });
    return gradient;
  }

  Mlp mlp_;
  Vector parameters_;
  Doubles doubles_;
  MlpWorkspace workspace_;
  std::vector<int16_t> units_;
  std::vector<float> values_;
  std::vector<std::vector<float>> observations_;
};

TEST_P(MlpGradient, ForwardIsThatOfPlainLoops) {
  for (int column = 0; column < kBatch; ++column) {
    const Doubles outputs = LiteralOutputs(column);
    for (size_t i = 0; i < outputs.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(workspace_.output()(static_cast<int>(i), column)), outputs[i], 2e-5);
    }
  }
}

TEST_P(MlpGradient, BackwardIsTheFiniteDifferenceOfTheLoss) {
  const std::vector<float> gradient = Backward(kBatch);
  constexpr double kStep = 1e-6;
  const size_t stride = doubles_.size() / 400 + 1;
  for (size_t i = 0; i < doubles_.size(); i += stride) {
    const double value = doubles_[i];
    doubles_[i] = value + kStep;
    const double above = LiteralLoss();
    doubles_[i] = value - kStep;
    const double below = LiteralLoss();
    doubles_[i] = value;
    EXPECT_NEAR(static_cast<double>(gradient[i]), (above - below) / (2 * kStep), 2e-4) << "parameter " << i;
  }
}

TEST_P(MlpGradient, BitsDoNotDependOnHowColumnsAreDivided) {
  const std::vector<float> together = Backward(kBatch);
  for (const int columns_at_once : {1, 2, 3, 8}) {
    EXPECT_EQ(Backward(columns_at_once), together) << columns_at_once;
  }
}

TEST_P(MlpGradient, PartsAreAllParametersOnce) {
  int64_t next = 0;
  for (const ParameterPart& part : mlp_.parts()) {
    EXPECT_EQ(part.first, next);
    EXPECT_GT(part.end, part.first);
    next = part.end;
  }
  EXPECT_EQ(next, mlp_.shape().parameter_count());
}

INSTANTIATE_TEST_SUITE_P(Shapes, MlpGradient,
                         ::testing::Values(std::vector<int>{7, 20, 25, 20}, std::vector<int>{5, 64, 10},
                                           std::vector<int>{9, 12}, std::vector<int>{4, 8, 8, 8, 10},
                                           std::vector<int>{3, 200, 70, 5}));

using Bits = std::vector<uint32_t>;

Bits OutputBits(const MlpWorkspace& workspace, int column) {
  const Matrix& output = workspace.output();
  Bits bits(static_cast<size_t>(output.rows()));
  std::memcpy(bits.data(), output.col(column).data(), bits.size() * sizeof(uint32_t));
  return bits;
}

class MlpBits : public ::testing::TestWithParam<std::vector<int>> {
 protected:
  MlpBits() : mlp_(MlpShape(GetParam())), parameters_(mlp_.InitialParameters(3)) {
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
    mlp_.Forward(Values(parameters_), {0, static_cast<int>(members.size())}, workspace);
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
    mlp_.Forward(Values(parameters_), {0, width}, workspace);
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

TEST(InitialParameters, AreUniformWithinHesBoundAndBiasesAreZero) {
  const MlpShape shape({7, 200, 256, 20});
  EXPECT_EQ(shape.parameter_count(), 7 * 200 + 200 + 200 * 256 + 256 + 256 * 20 + 20);
  const Vector parameters = Mlp(shape).InitialParameters(1);
  for (int layer = 0; layer < shape.layers(); ++layer) {
    const double bound = std::sqrt(6.0 / shape.layer_inputs(layer));
    double sum = 0;
    double largest = 0;
    for (int64_t i = shape.weights_offset(layer); i < shape.biases_offset(layer); ++i) {
      sum += static_cast<double>(parameters(i));
      largest = std::max(largest, std::abs(static_cast<double>(parameters(i))));
    }
    const auto count = static_cast<double>(shape.biases_offset(layer) - shape.weights_offset(layer));
    EXPECT_LE(largest, bound * 1.000001);
    EXPECT_GT(largest, 0.98 * bound);
    EXPECT_NEAR(sum / count, 0, 5 * bound / std::sqrt(3 * count));  // five standard errors
    for (int i = 0; i < shape.layer_outputs(layer); ++i) {
      EXPECT_EQ(parameters(shape.biases_offset(layer) + i), 0.0f);
    }
  }
}

TEST(InitialParameters, FollowFromTheSeed) {
  const MlpShape shape({5, 8, 10});
  EXPECT_EQ(Mlp(shape).InitialParameters(1), Mlp(shape).InitialParameters(1));
  EXPECT_NE(Mlp(shape).InitialParameters(1), Mlp(shape).InitialParameters(2));
}

}  // namespace
}  // namespace fresco
