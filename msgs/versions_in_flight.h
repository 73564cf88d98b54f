// Computes how many versions of the networks the orders in flight can name. A pure function; any thread may
// call it.
#pragma once

#include <cstdint>

#include "msgs/experiment.h"

namespace fresco {

/// The largest numbers of versions in flight. A version is in flight from when it is made until no order in
/// flight names it or an older one; there are schedule.window training orders in flight.
struct VersionsInFlight {
  int64_t current = 0;
  int64_t target = 0;
  int64_t both() const { return current + target; }
};
VersionsInFlight MostVersionsInFlight(const Experiment& experiment);

}  // namespace fresco
