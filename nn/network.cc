#include "nn/network.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace fresco {
namespace {

// A part has about so many parameters.
constexpr int kParametersOfPart = 4096;
constexpr int kInputMultiple = 8;

std::vector<ParameterPart> PartsOf(std::span<const Layer> layers) {
  std::vector<ParameterPart> parts;
  for (int i = 0; i < static_cast<int>(layers.size()); ++i) {
    const Layer& layer = layers[static_cast<size_t>(i)];
    const int multiples = std::max(1, kParametersOfPart / (layer.outputs * kInputMultiple));
    for (int input = 0; input < layer.inputs; input += multiples * kInputMultiple) {
      const int end = std::min(layer.inputs, input + multiples * kInputMultiple);
      const int64_t first = layer.weights + int64_t{input} * layer.outputs;
      const int64_t biases = end == layer.inputs ? 1 : 0;
      parts.push_back({i, input, end, first, first + (end - input + biases) * int64_t{layer.outputs}});
    }
  }
  return parts;
}

}  // namespace

std::span<const float> Values(const Vector& vector) {
  return {vector.data(), static_cast<size_t>(vector.size())};
}

std::span<float> Values(Vector& vector) {
  return {vector.data(), static_cast<size_t>(vector.size())};
}

Network::Network(std::vector<Layer> layers) : layers_(std::move(layers)), parts_(PartsOf(layers_)) {
  FRESCO_CHECK(!layers_.empty());
}

Vector Network::InitialParameters(uint64_t seed) const {
  Vector parameters = Vector::Zero(parameter_count());
  for (size_t i = 0; i < layers_.size(); ++i) {
    RandomStream stream(seed, RandomPurpose::kInitialWeights, static_cast<uint32_t>(i), 0);
    const double bound = std::sqrt(6.0 / layers_[i].inputs);
    for (int64_t weight = layers_[i].weights; weight < layers_[i].biases(); ++weight) {
      parameters(weight) = static_cast<float>((2 * stream.NextUniform() - 1) * bound);
    }
  }
  return parameters;
}

int64_t Network::LargestPart() const {
  return std::max_element(parts_.begin(), parts_.end(),
                          [](const auto& a, const auto& b) { return a.size() < b.size(); })
      ->size();
}

}  // namespace fresco
