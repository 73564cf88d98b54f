// Turns a flight into the JSON object that `fresco evaluate --format json` prints. A pure function; any
// thread may call it.
#pragma once

#include <optional>
#include <string>

#include "planner/planner.h"

namespace fresco {

/// Returns an object with policy, arrived, outcome, slots, total_aoi, average_aoi, sum_aoi, residual_energy_j
/// and flight. The latter is a list of {slot, column, row, move, scheduled, aoi}, one for each slot, with the
/// AoI at its beginning. If there is a plan, the object also has optimal, lower_bound_total_aoi and
/// lower_bound_average_aoi.
std::string FlightJson(const World& world, const Episode& flight, const std::string& policy,
                       const std::optional<Plan>& plan = std::nullopt);

}  // namespace fresco
