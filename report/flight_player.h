// The drawing of the UAV's world on the report page: a player that shows flights slot by slot. Any thread may
// use it.
#pragma once

#include "report/drawings.h"

namespace fresco {

/// Its HTML contains every AoI of every slot, which take about 4 bytes each. The flight that is first in the
/// list is shown first.
extern const Drawing kFlightPlayer;

}  // namespace fresco
