// The worlds and orders of transitions_fuzz, which the writer of its corpus uses as well.
#pragma once

#include <cstdint>

#include "msgs/experiment.h"
#include "msgs/order.h"
#include "tests/worlds/walk_world.h"
#include "worlds/cartpole/cartpole.h"

namespace fresco {

inline constexpr int64_t kFuzzedOrders = 4;
inline constexpr uint8_t kFuzzedWorlds = 3;

/// The paper's world with three sensors; CartPole; a walk with states too long for one message, which can't
/// be flown again.
inline const World& FuzzedWorld(uint8_t number) {
  static const Experiment paper = Experiment::Parse("", "the defaults");
  static const CartPole cartpole(50);
  static const WalkWorld walk([] {
    WorldDescription description = WalkWorld::WideDescription(200);
    description.repeatable = false;
    return description;
  }());
  const World* const worlds[kFuzzedWorlds] = {&paper.world(), &cartpole, &walk};
  return *worlds[number % kFuzzedWorlds];
}

inline Order FuzzedOrder(int64_t index) {
  Order order;
  order.index = index;
  order.seed = static_cast<uint64_t>(index);
  return order;
}

}  // namespace fresco
