// Adam against Algorithm 1 of Kingma and Ba, written out in double precision.
#include "nn/adam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/nn/literal_network.h"

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

void Step(Adam& adam, const std::vector<float>& gradient, double learning_rate,
          std::vector<float>& parameters) {
  adam.Step(adam.Begin(learning_rate), 0, gradient, parameters);
}

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
    Step(adam, gradient, learning_rate, parameters);
    literal.Step(Doubles(gradient.begin(), gradient.end()), learning_rate, literal_parameters);
  }
  for (size_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(static_cast<double>(parameters[i]), literal_parameters[i], 2e-4) << i;
  }
}

TEST(Adam, FirstStepIsTheLearningRateAgainstTheGradientsSign) {
  std::vector<float> parameters = {1.0f, 1.0f, 1.0f};
  const std::vector<float> gradient = {0.5f, -20.0f, 0.0f};
  Adam adam(3, {});
  Step(adam, gradient, 0.01, parameters);
  EXPECT_NEAR(parameters[0], 0.99f, 1e-6);
  EXPECT_NEAR(parameters[1], 1.01f, 1e-6);
  EXPECT_EQ(parameters[2], 1.0f);
}

TEST(Adam, GoesOnBitForBitFromItsState) {
  RandomStream stream(2, RandomPurpose::kTest, 0, 0);
  std::vector<float> parameters = RandomFloats(stream, 100, 1);
  Adam adam(100, {});
  Step(adam, RandomFloats(stream, 100, 1), 1e-2, parameters);
  Adam resumed(100, {});
  resumed.Restore(adam.state());
  std::vector<float> resumed_parameters = parameters;
  const std::vector<float> gradient = RandomFloats(stream, 100, 1);
  Step(adam, gradient, 1e-2, parameters);
  Step(resumed, gradient, 1e-2, resumed_parameters);
  EXPECT_EQ(parameters, resumed_parameters);
}

TEST(Adam, BitsDoNotDependOnHowTheParametersAreDivided) {
  constexpr int64_t kCount = 100;
  RandomStream stream(3, RandomPurpose::kTest, 0, 0);
  const std::vector<float> initial = RandomFloats(stream, kCount, 1);
  const std::vector<float> gradient = RandomFloats(stream, kCount, 1);
  std::vector<float> together = initial;
  Adam adam(kCount, {});
  Step(adam, gradient, 1e-2, together);
  for (const int64_t at_once : {1, 7, 16, 33}) {
    std::vector<float> divided = initial;
    Adam other(kCount, {});
    const AdamStep step = other.Begin(1e-2);
    for (int64_t first = 0; first < kCount; first += at_once) {
      const auto begin = static_cast<size_t>(first);
      const auto count = static_cast<size_t>(std::min(at_once, kCount - first));
      other.Step(step, first, std::span(gradient).subspan(begin, count),
                 std::span(divided).subspan(begin, count));
    }
    EXPECT_EQ(divided, together) << at_once;
  }
}

}  // namespace
}  // namespace fresco
