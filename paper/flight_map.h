// Draws a flight seen from above: where the UAV was in each slot, and from where it served which sensor. A
// pure function; any thread may call it.
#pragma once

#include <string>

#include "report/picture.h"
#include "worlds/uav/flight.h"

namespace fresco {

/// The picture shows the grid, with axes in cells of equal length and row 0 at the bottom; the sensors with
/// their numbers and coverage; the path, coloured by slot; and a dot wherever the UAV collected, joined with
/// that sensor. In each slot the path is shifted by a small part of a cell, so that several passes over the
/// same cells are visible. `flight` has at least one slot and was flown in `world`.
Picture DrawFlightMap(const std::string& title, const UavWorld& world, const Episode& flight);

}  // namespace fresco
