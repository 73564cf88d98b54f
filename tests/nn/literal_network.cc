#include "tests/nn/literal_network.h"

#include <algorithm>

namespace fresco {

Doubles LiteralForward(const std::vector<int>& layer_sizes, const Doubles& parameters,
                       const Doubles& observation) {
  Doubles below = observation;
  size_t offset = 0;
  for (size_t layer = 0; layer + 1 < layer_sizes.size(); ++layer) {
    const auto inputs = static_cast<size_t>(layer_sizes[layer]);
    const auto outputs = static_cast<size_t>(layer_sizes[layer + 1]);
    Doubles above(outputs);
    for (size_t unit = 0; unit < outputs; ++unit) {
      above[unit] = parameters[offset + inputs * outputs + unit];
      for (size_t input = 0; input < inputs; ++input) {
        above[unit] += parameters[offset + input * outputs + unit] * below[input];
      }
      if (layer + 2 < layer_sizes.size()) {
        above[unit] = std::max(above[unit], 0.0);
      }
    }
    offset += inputs * outputs + outputs;
    below = above;
  }
  return below;
}

std::vector<float> RandomFloats(RandomStream& stream, size_t count, double bound) {
  std::vector<float> values(count);
  for (float& value : values) {
    value = static_cast<float>((2 * stream.NextUniform() - 1) * bound);
  }
  return values;
}

void SetColumn(MlpWorkspace& workspace, int column, const std::vector<float>& observation) {
  std::copy(observation.begin(), observation.end(), workspace.input().col(column).data());
}

}  // namespace fresco
