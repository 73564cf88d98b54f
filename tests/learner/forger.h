// Somebody on the network who has no key: reads every order and answers it at once, before any actor, with an
// episode that is possible but not the one that was ordered. Nothing in it gives it away.
#pragma once

#include "bus/bus.h"
#include "msgs/channels.h"
#include "msgs/experiment.h"
#include "msgs/wire.h"
#include "worlds/uav/world.h"

namespace fresco {

class Forger {
 public:
  /// Subscribes on `bus`, which like `world` and `experiment` must outlive the forger.
  Forger(const Experiment& experiment, const World& world, Bus& bus, const Channels& channels);

 private:
  void Answer(const orders_t& message);

  const Experiment* experiment_;
  const World* world_;
  Bus* bus_;
  Channels channels_;
};

}  // namespace fresco
