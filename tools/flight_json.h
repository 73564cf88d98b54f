// A flight as the JSON object that `fresco evaluate --format json` prints.
#pragma once

#include <string>

#include "uav/flight.h"

namespace fresco {

/// Keys: policy, arrived, outcome, slots, total_aoi, average_aoi, sum_aoi, residual_energy_j, flight:
/// one {slot, column, row, move, scheduled, aoi} a slot, aoi at the beginning of the slot.
std::string FlightJson(const World& world, const Flight& flight, const std::string& policy);

}  // namespace fresco
