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

Doubles LiteralForward(const SetShape& shape, const Doubles& parameters, const Doubles& observation) {
  auto next = parameters.begin();
  // The outputs of layers whose parameters follow those of the last call.
  const auto layers_of = [&](std::vector<int> sizes) {
    std::ptrdiff_t count = 0;
    for (size_t layer = 0; layer + 1 < sizes.size(); ++layer) {
      count += (sizes[layer] + 1) * sizes[layer + 1];
    }
    const Doubles own(next, next + count);
    next += count;
    return [=](const Doubles& input, bool rectified) {
      Doubles output = LiteralForward(sizes, own, input);
      for (double& value : output) {
        value = rectified ? std::max(value, 0.0) : value;
      }
      return output;
    };
  };
  const auto sizes = [](int inputs, const std::vector<int>& layers) {
    std::vector<int> all = {inputs};
    all.insert(all.end(), layers.begin(), layers.end());
    return all;
  };
  const int encodings = shape.encoder_layers.back();
  const int hidden_units = shape.trunk_layers.back();
  const auto encoder = layers_of(sizes(shape.own_inputs + shape.item_inputs, shape.encoder_layers));
  const auto trunk = layers_of(sizes(shape.own_inputs + 2 * encodings, shape.trunk_layers));
  const auto linear = layers_of({hidden_units, shape.groups});
  std::vector<int> head_sizes = sizes(hidden_units + encodings, shape.head_layers);
  head_sizes.push_back(shape.groups);
  const auto head = layers_of(head_sizes);

  const Doubles own(observation.begin(), observation.begin() + shape.own_inputs);
  const auto joined = [](Doubles a, const Doubles& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  std::vector<Doubles> encoded;  // empty: the item is absent
  Doubles largest(static_cast<size_t>(encodings), 0.0);
  Doubles mean(static_cast<size_t>(encodings), 0.0);
  double present = 0;
  for (int item = 0; item < shape.items; ++item) {
    const auto first = observation.begin() + shape.own_inputs + item * shape.item_inputs;
    encoded.push_back(*first == 0 ? Doubles()
                                  : encoder(joined(own, {first, first + shape.item_inputs}), true));
    present += *first == 0 ? 0 : 1;
    for (size_t i = 0; i < encoded.back().size(); ++i) {
      largest[i] = std::max(largest[i], encoded.back()[i]);
      mean[i] += encoded.back()[i];
    }
  }
  for (double& value : mean) {
    value /= std::max(present, 1.0);
  }
  const Doubles hidden = trunk(joined(joined(own, largest), mean), true);
  const Doubles of_whole = linear(hidden, false);
  Doubles values;
  for (size_t group = 0; group < of_whole.size(); ++group) {
    values.push_back(of_whole[group]);
    for (const Doubles& encoding : encoded) {
      values.push_back(encoding.empty() ? 0 : head(joined(hidden, encoding), false)[group]);
    }
  }
  return values;
}

std::vector<float> RandomFloats(RandomStream& stream, size_t count, double bound) {
  std::vector<float> values(count);
  for (float& value : values) {
    value = static_cast<float>((2 * stream.NextUniform() - 1) * bound);
  }
  return values;
}

void SetColumn(NetworkWorkspace& workspace, int column, const std::vector<float>& observation) {
  std::copy(observation.begin(), observation.end(), workspace.input().col(column).data());
}

}  // namespace fresco
