// The networks once more, in double precision and plain loops: what nn/ is checked against.
#pragma once

#include <vector>

#include "core/random.h"
#include "nn/network.h"
#include "nn/set_network.h"

namespace fresco {

using Doubles = std::vector<double>;

/// Outputs for one observation.
Doubles LiteralForward(const std::vector<int>& layer_sizes, const Doubles& parameters,
                       const Doubles& observation);

/// The same for a SetNetwork.
Doubles LiteralForward(const SetShape& shape, const Doubles& parameters, const Doubles& observation);

/// Uniform values in [-bound, bound).
std::vector<float> RandomFloats(RandomStream& stream, size_t count, double bound);

/// Writes one observation into a column of a workspace's input.
void SetColumn(NetworkWorkspace& workspace, int column, const std::vector<float>& observation);

}  // namespace fresco
