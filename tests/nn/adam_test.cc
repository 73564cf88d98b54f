// Adam against Algorithm 1 of Kingma and Ba, written out in double precision. No heap use in forward,
// backward and Adam once warm: every allocation of this program is counted.
#include "nn/adam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/nn/literal_network.h"
#include "tests/support/allocation_count.h"

namespace fresco {
namespace {

/// Algorithm 1, to the letter.
class LiteralAdam {
 public:
  explicit LiteralAdam(size_t count) : m_(count), v_(count) {}
  void Step(const Doubles& gradient, double learning_rate, Doubles& parameters) {
    ++t_;
    for (size_t i = 0; i < parameters.size(); ++i) {
      m_[i] = 0.9 * m_[i] + 0.1 * gradient[i];
      v_[i] = 0.999 * v_[i] + 0.001 * gradient[i] * gradient[i];
      const double m_hat = m_[i] / (1 - std::pow(0.9, t_));
      const double v_hat = v_[i] / (1 - std::pow(0.999, t_));
      parameters[i] -= learning_rate * m_hat / (std::sqrt(v_hat) + 1e-8);
    }
  }

 private:
  int t_ = 0;
  Doubles m_, v_;
};

TEST(Adam, FollowsAlgorithm1) {
  constexpr size_t kCount = 37;
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  std::vector<float> parameters = RandomFloats(stream, kCount, 1);
  Doubles literal_parameters(parameters.begin(), parameters.end());
  Adam adam(kCount, {});
  LiteralAdam literal(kCount);
  for (int step = 0; step < 1000; ++step) {
    const double learning_rate = step < 500 ? 1e-2 : 1e-3;
    const std::vector<float> gradient = RandomFloats(stream, kCount, step % 7 == 0 ? 1e-3 : 1.0);
    adam.Step(gradient, learning_rate, parameters);
    literal.Step(Doubles(gradient.begin(), gradient.end()), learning_rate, literal_parameters);
  }
  for (size_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(static_cast<double>(parameters[i]), literal_parameters[i], 2e-4) << i;
  }
}

TEST(Adam, FirstStepIsTheLearningRateAgainstTheGradientsSign) {
  std::vector<float> parameters = {1.0f, 1.0f, 1.0f};
  const std::vector<float> gradient = {0.5f, -20.0f, 0.0f};
  Adam(3, {}).Step(gradient, 0.01, parameters);
  EXPECT_NEAR(parameters[0], 0.99f, 1e-6);
  EXPECT_NEAR(parameters[1], 1.01f, 1e-6);
  EXPECT_EQ(parameters[2], 1.0f);
}

TEST(Adam, GoesOnBitForBitFromItsState) {
  RandomStream stream(2, RandomPurpose::kTest, 0, 0);
  std::vector<float> parameters = RandomFloats(stream, 100, 1);
  Adam adam(100, {});
  adam.Step(RandomFloats(stream, 100, 1), 1e-2, parameters);
  Adam resumed(100, {});
  resumed.Restore(adam.state());
  std::vector<float> resumed_parameters = parameters;
  const std::vector<float> gradient = RandomFloats(stream, 100, 1);
  adam.Step(gradient, 1e-2, parameters);
  resumed.Step(gradient, 1e-2, resumed_parameters);
  EXPECT_EQ(parameters, resumed_parameters);
}

#ifndef FRESCO_SANITIZED

TEST(Allocations, AreSeenByThisTest) {
  const int64_t before = AllocationCount();
  const auto memory = std::make_unique<Matrix>(Matrix::Zero(10, 10));
  EXPECT_GE(AllocationCount() - before, 2);
}

TEST(Allocations, DoNotHappenInForwardBackwardAndAdamOnceWarm) {
  constexpr int kBatch = 200;
  const Mlp mlp(MlpShape({7, 200, 256, 20}));
  Vector parameters = InitialParameters(mlp.shape(), 1);
  MlpWorkspace workspace(mlp.shape(), kBatch);
  workspace.input().setOnes();
  const Matrix output_gradient = Matrix::Ones(20, kBatch);
  Vector gradient(parameters.size());
  Adam adam(parameters.size(), {});
  const std::span<float> gradient_span(gradient.data(), static_cast<size_t>(gradient.size()));
  const auto update = [&](int batch) {
    mlp.Forward(SpanOf(parameters), batch, workspace);
    mlp.Backward(SpanOf(parameters), batch, output_gradient, workspace, gradient_span);
    adam.Step(gradient_span, 1e-3, {parameters.data(), static_cast<size_t>(parameters.size())});
  };
  update(kBatch);
  const int64_t before = AllocationCount();
  for (const int batch : {kBatch, 1, 17, kBatch}) {
    update(batch);
  }
  EXPECT_EQ(AllocationCount(), before);
}

#endif

}  // namespace
}  // namespace fresco
