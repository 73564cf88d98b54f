// Policies in formats that other programs read. Each function is pure; any thread may call it.
#pragma once

#include <string>

#include "storage/network_file.h"

namespace fresco {

/// An ONNX model (opset 13), serialized. Its input `state`, single precision [batch x fields], is a state in
/// the units of WorldDescription::state. Its outputs are `action`, int64 [batch], the allowed action with the
/// largest value (of several, the first one), `values`, single precision [batch x actions], and `mask`, bool
/// [batch x actions], what is allowed. If only the world's environments know the mask, it is a second input
/// instead. Throws UsageError if the world can't state its observations as formulas.
std::string OnnxModel(const StoredNetwork& network);

/// A header in C++17 without dependencies, which computes the same in the namespace `name`, values to the
/// bit. Throws UsageError as OnnxModel does, and if `name` is not one for a namespace.
std::string CppHeader(const StoredNetwork& network, const std::string& name);

/// The parameters of the network as CSV, a row for each: "chain,layer,output,input,value". Layers of a chain
/// follow each other, from 1; a bias has no input. A multilayer perceptron has the chain "network", a network
/// for sets has "encoder", "trunk" and "head" (nn/set_network.h).
std::string ParametersCsv(const StoredNetwork& network);

}  // namespace fresco
