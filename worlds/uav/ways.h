// Lengths of ways as a network for sets sees them, and those over an open grid; map_input.h has those round
// obstacles. Pure functions, so any thread may call them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "worlds/uav/scenario.h"

namespace fresco {

/// The lengths of a way, in moves: from the UAV's cell, and from where it is after a move to the north, the
/// south, the east or the west. A move that is not possible leaves it where it is. ObstacleMap::kCutOff:
/// there is no way.
inline constexpr size_t kWayInputs = 5;
using Ways = std::array<int16_t, kWayInputs>;

/// Writes the kWayInputs of a way: its length divided by `longer_side`, the larger number of columns and rows
/// (at most 2, also if there is no way); and for each of the four moves by how many moves it is shorter after
/// this move: 1, 0 or -1.
void WriteWays(const Ways& ways, int longer_side, std::span<float> input);

/// The ways over an open grid from `cell` to the stop.
Ways OpenWaysToStop(int columns, int rows, Cell cell, Cell stop);

/// The ways over an open grid from `cell` to the nearest cell that covers a sensor with this radius.
Ways OpenWaysToSensor(int columns, int rows, double cell_m, Cell cell, const Sensor& sensor, double radius_m);

}  // namespace fresco
