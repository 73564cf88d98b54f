// A flight as the JSON object that `fresco evaluate --format json` prints.
#pragma once

#include <optional>
#include <string>

#include "planner/planner.h"

namespace fresco {

/// Keys: policy, arrived, outcome, slots, total_aoi, average_aoi, sum_aoi, residual_energy_j, flight:
/// one {slot, column, row, move, scheduled, aoi} a slot, aoi at the beginning of the slot. With a plan
/// also optimal, lower_bound_total_aoi and lower_bound_average_aoi.
std::string FlightJson(const World& world, const Flight& flight, const std::string& policy,
                       const std::optional<Plan>& plan = std::nullopt);

}  // namespace fresco
