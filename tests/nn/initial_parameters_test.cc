#include <gtest/gtest.h>

#include <cmath>

#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

TEST(InitialParameters, AreUniformWithinTheirBoundsAndTheOutputsBiasesAreZero) {
  const MlpShape shape({7, 200, 256, 20});
  EXPECT_EQ(shape.parameter_count(), 7 * 200 + 200 + 200 * 256 + 256 + 256 * 20 + 20);
  const Vector parameters = InitialParameters(shape, 1);
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
    const Vector biases = parameters.segment(shape.biases_offset(layer), shape.layer_outputs(layer));
    const float bias_bound = layer < 2 ? 1 / std::sqrt(static_cast<float>(shape.layer_inputs(layer))) : 0;
    EXPECT_LE(biases.maxCoeff(), bias_bound);
    EXPECT_GE(biases.minCoeff(), -bias_bound);
    EXPECT_GE(biases.maxCoeff() - biases.minCoeff(), 1.9f * bias_bound);
    EXPECT_NEAR(biases.mean(), 0, 5 * bias_bound / std::sqrt(3.0f * static_cast<float>(biases.size())));
  }
}

TEST(InitialParameters, FollowFromTheSeed) {
  const MlpShape shape({5, 8, 10});
  EXPECT_EQ(InitialParameters(shape, 1), InitialParameters(shape, 1));
  EXPECT_NE(InitialParameters(shape, 1), InitialParameters(shape, 2));
}

}  // namespace
}  // namespace fresco
