// The paper's two comparison algorithms (section IV), with the choices of docs/paper.md. Pure.
#pragma once

#include <string_view>
#include <vector>

#include "uav/environment.h"

namespace fresco {

enum class BaselineKind { kAoi, kDistance };

/// A baseline flying one episode at a time. Serves on the way the covered sensor with the largest
/// AoI; flies to the stop as soon as the wanted move would put it out of reach, so it always arrives.
class Baseline {
 public:
  Baseline(BaselineKind kind, const World& world);
  void Reset();
  /// The action for the environment's present state; updates the round of the distance baseline.
  Action Choose(const Environment& environment);

 private:
  BaselineKind kind_;
  const World* world_;
  std::vector<uint8_t> served_;  // this round, kDistance only
};

}  // namespace fresco
