// Forward against plain loops in double precision; gradients against central finite differences of them.
#include <gtest/gtest.h>

#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

constexpr int kBatch = 11;

class MlpGradient : public ::testing::TestWithParam<std::vector<int>> {
 protected:
  MlpGradient()
      : mlp_(MlpShape(GetParam())),
        parameters_(InitialParameters(mlp_.shape(), 5)),
        workspace_(mlp_.shape(), kBatch),
        loss_gradient_(mlp_.shape().outputs(), kBatch) {
    RandomStream stream(7, RandomPurpose::kTest, 0, 0);
    for (int layer = 0; layer < mlp_.shape().layers(); ++layer) {
      const auto biases = RandomFloats(stream, static_cast<size_t>(mlp_.shape().layer_outputs(layer)), 0.5);
      std::copy(biases.begin(), biases.end(), parameters_.data() + mlp_.shape().biases_offset(layer));
    }
    for (int column = 0; column < kBatch; ++column) {
      observations_.push_back(RandomFloats(stream, static_cast<size_t>(mlp_.shape().inputs()), 1));
      SetColumn(workspace_, column, observations_.back());
      const auto gradient = RandomFloats(stream, static_cast<size_t>(mlp_.shape().outputs()), 1);
      std::copy(gradient.begin(), gradient.end(), loss_gradient_.col(column).data());
    }
    doubles_.assign(parameters_.data(), parameters_.data() + parameters_.size());
    mlp_.Forward(SpanOf(parameters_), kBatch, workspace_);
  }

  Doubles LiteralOutputs(int column) const {
    const auto& observation = observations_[static_cast<size_t>(column)];
    return LiteralForward(GetParam(), doubles_, Doubles(observation.begin(), observation.end()));
  }

  /// A loss that is linear in the outputs, so that its gradient there is loss_gradient_.
  double LiteralLoss() const {
    double loss = 0;
    for (int column = 0; column < kBatch; ++column) {
      const Doubles outputs = LiteralOutputs(column);
      for (size_t i = 0; i < outputs.size(); ++i) {
        loss += outputs[i] * static_cast<double>(loss_gradient_(static_cast<int>(i), column));
      }
    }
    return loss;
  }

  Mlp mlp_;
  Vector parameters_;
  Doubles doubles_;
  MlpWorkspace workspace_;
  Matrix loss_gradient_;
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
  std::vector<float> gradient(static_cast<size_t>(parameters_.size()));
  mlp_.Backward(SpanOf(parameters_), kBatch, loss_gradient_, workspace_, gradient);
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

TEST_P(MlpGradient, BackwardOverwritesTheGradient) {
  std::vector<float> first(static_cast<size_t>(parameters_.size()), 123.0f);
  std::vector<float> second(first.size(), -4.0f);
  mlp_.Backward(SpanOf(parameters_), kBatch, loss_gradient_, workspace_, first);
  mlp_.Backward(SpanOf(parameters_), kBatch, loss_gradient_, workspace_, second);
  EXPECT_EQ(first, second);
}

INSTANTIATE_TEST_SUITE_P(Shapes, MlpGradient,
                         ::testing::Values(std::vector<int>{7, 20, 25, 20}, std::vector<int>{5, 64, 10},
                                           std::vector<int>{9, 12}, std::vector<int>{4, 8, 8, 8, 10}));

}  // namespace
}  // namespace fresco
