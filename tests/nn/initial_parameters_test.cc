#include <gtest/gtest.h>

#include <cmath>

#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

TEST(InitialParameters, AreUniformWithinHesBoundAndBiasesAreZero) {
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
    for (int i = 0; i < shape.layer_outputs(layer); ++i) {
      EXPECT_EQ(parameters(shape.biases_offset(layer) + i), 0.0f);
    }
  }
}

TEST(InitialParameters, FollowFromTheSeed) {
  const MlpShape shape({5, 8, 10});
  EXPECT_EQ(InitialParameters(shape, 1), InitialParameters(shape, 1));
  EXPECT_NE(InitialParameters(shape, 1), InitialParameters(shape, 2));
}

}  // namespace
}  // namespace fresco
