// The UAV's world of an experiment, for tests.
#pragma once

#include "msgs/experiment.h"
#include "worlds/uav/uav_world.h"

namespace fresco {

inline const UavWorld& UavWorldOf(const Experiment& experiment) {
  return RequireUavWorld(experiment.world(), "the test");
}

}  // namespace fresco
