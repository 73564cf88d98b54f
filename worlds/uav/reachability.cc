// The part of world.h that decides whether the stop can still be reached.
#include <algorithm>

#include "core/error.h"
#include "worlds/uav/world.h"

namespace fresco {

double EnergyMargin(const World& world, Cell cell, int slots_left, double remaining_j) {
  if (world.flying_energy_j() <= world.hovering_energy_j()) {
    return remaining_j - slots_left * world.flying_energy_j();
  }
  const int flown = std::min(world.DistanceToStop(cell), slots_left);
  return remaining_j - flown * world.flying_energy_j() - (slots_left - flown) * world.hovering_energy_j();
}

double CompletionEnergy(const World& world, Cell cell, int slots_left) {
  const int slack = slots_left - world.DistanceToStop(cell);
  FRESCO_CHECK(slack >= 0);
  const bool hovering_is_dearer = world.hovering_energy_j() > world.flying_energy_j();
  const bool single_cell = world.scenario().columns == 1 && world.scenario().rows == 1;
  // Flying to a neighbouring cell and back takes two slots, so it uses up an even number of spare slots.
  const int hovers = hovering_is_dearer && !single_cell ? slack % 2 : slack;
  return (slots_left - hovers) * world.flying_energy_j() + hovers * world.hovering_energy_j();
}

bool CanReachStop(const World& world, Cell cell, int slots_left, double remaining_j) {
  return world.DistanceToStop(cell) <= slots_left && remaining_j >= CompletionEnergy(world, cell, slots_left);
}

}  // namespace fresco
