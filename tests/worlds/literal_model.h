// A second, slow statement of the model, written from docs/paper.md and not from worlds/uav/: it looks at the
// whole sequence of actions each time, and shares only the plain structs with the product.
#pragma once

#include <string>
#include <vector>

#include "worlds/uav/scenario.h"
#include "worlds/uav/uav_world.h"

namespace fresco {

/// s_t after a sequence of t - 1 actions, the last reward r_{t-1}, and how the episode stands.
struct LiteralState {
  Cell cell;
  std::vector<int> aoi;
  int phi = 0;
  double delta_j = 0;
  double remaining_j = 0;
  double reward = 0;
  std::string outcome;
};

/// Whether the cell is on the grid, and no obstacle to flight of the map, if there is one.
bool MayFlyLiterally(const Scenario& scenario, Cell cell);
/// The moves of the shortest flight between two cells: Manhattan, or with a map by setting distances until
/// none falls any more; a million if there is no flight.
int LiteralDistance(const Scenario& scenario, Cell from, Cell to);
/// Whether no cell that blocks radio, other than the sensor's, is cut by the line from the cell's centre to
/// the sensor: for each such cell, an edge or the line itself has all of the cell on one side. Places are
/// rounded to a 2^16-th of a cell.
bool HasLineOfSightLiterally(const Scenario& scenario, Cell cell, const Sensor& sensor);

double LiteralPower(const Rotor& rotor, double speed_mps);
LiteralState SimulateLiterally(const Scenario& scenario, const std::vector<Action>& actions);

/// Whether any sequence of moves leads to the stop in exactly `slots_left` moves without using more
/// than `remaining_j`: exhaustive over cells and numbers of hovers.
bool SomeFlightReachesStop(const Scenario& scenario, Cell cell, int slots_left, double remaining_j);

}  // namespace fresco
