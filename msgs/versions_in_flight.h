// How many versions of the networks the orders in flight can name. Pure.
#pragma once

#include <cstdint>

#include "msgs/experiment.h"

namespace fresco {

/// At most. A version lives from when it is made until no order in flight names it or an older one, and of
/// these orders there are schedule.window.
struct VersionsInFlight {
  int64_t current = 0;
  int64_t target = 0;
  int64_t both() const { return current + target; }
};
VersionsInFlight MostVersionsInFlight(const Experiment& experiment);

}  // namespace fresco
