// A flight seen from above: where the UAV was when, and from where it served which sensor. Pure; any
// thread.
#pragma once

#include <string>

#include "report/picture.h"
#include "worlds/uav/flight.h"

namespace fresco {

/// The grid with its axes in cells, equal on both, row 0 at the bottom; sensors with their numbers and
/// coverage; the path with the slot as its colour; a dot where the UAV was when it collected, joined with
/// the sensor that it collected from. Slot by slot the path is shifted by a small part of a cell, so that
/// passes over the same cells lie side by side. `flight` has at least one slot and is one of `world`.
Picture DrawFlightMap(const std::string& title, const World& world, const Flight& flight);

}  // namespace fresco
