#include <fmt/format.h>

#include <iterator>

#include "exports/exports.h"
#include "exports/policy_parts.h"

namespace fresco {

std::string ParametersCsv(const StoredNetwork& network) {
  std::string csv = "chain,layer,output,input,value\n";
  const auto add = [&](const Chain& chain, size_t layer, int output, const std::string& input, int64_t at) {
    fmt::format_to(std::back_inserter(csv), "{},{},{},{},{}\n", chain.name, layer + 1, output, input,
                   network.parameters[at]);
  };
  for (const Chain& chain : ChainsOf(*network.experiment.network())) {
    for (size_t i = 0; i < chain.layers.size(); ++i) {
      const Layer& layer = chain.layers[i];
      for (int output = 0; output < layer.outputs; ++output) {
        for (int input = 0; input < layer.inputs; ++input) {
          add(chain, i, output, std::to_string(input),
              layer.weights + int64_t{input} * layer.outputs + output);
        }
        add(chain, i, output, "", layer.biases() + output);
      }
    }
  }
  return csv;
}

}  // namespace fresco
