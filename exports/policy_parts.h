// What every format is made of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nn/network.h"
#include "storage/network_file.h"
#include "worlds/formulas.h"

namespace fresco {

/// Layers that follow each other, with ReLU between them, and what they are called.
struct Chain {
  std::string name;
  std::vector<Layer> layers;

  int inputs() const { return layers.front().inputs; }
  int outputs() const { return layers.back().outputs; }
};

/// The chains of a network: one, or, of a network for sets, encoder, trunk and head.
std::vector<Chain> ChainsOf(const Network& network);

/// What a policy computes from a state up to the network.
struct PolicyFormulas {
  Formulas list;
  StateFormulas of_state;
  std::vector<bool> used;  ///< by formula: whether the observation or the mask depends on it
};

/// Throws UsageError if the world can't state them.
std::unique_ptr<PolicyFormulas> FormulasOf(const World& world);

/// "current network version 3270 (327126 updates), world uav".
std::string PolicyTitle(const StoredNetwork& network);

}  // namespace fresco
