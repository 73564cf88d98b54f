// The figures of merit of an episode: its age of information, in the three forms that Fresco reports
// everywhere. Pure; an object belongs to one thread at a time.
#pragma once

#include <cstdint>

#include "worlds/uav/flight.h"

namespace fresco {

/// The AoI figures over t = 1..T of an episode.
struct AoiFigures {
  int64_t total_aoi = 0;   ///< sum_t sum_n delta_{n,t}
  double average_aoi = 0;  ///< J = (1/T) sum_t sum_n theta_n delta_{n,t}; the weights theta sum to one
  double sum_aoi = 0;      ///< J with theta_n = 1
};

/// The figures of an episode that begins at the start. One that ended early is charged as if nothing were
/// collected any more until slot T, so that ending early never looks better.
AoiFigures Figures(const UavWorld& world, const Episode& episode);

}  // namespace fresco
