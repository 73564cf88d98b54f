// The UAV's world as formulas (worlds/formulas.h): what the network sees of a state, and what the mask
// allows.
#pragma once

#include "worlds/formulas.h"
#include "worlds/uav/uav_fields.h"
#include "worlds/uav/uav_world.h"

namespace fresco {

/// Of one field. What depends on the cell only is in tables with a row for every cell.
StateFormulas FormulasOfField(const UavWorld& world, Formulas& formulas);

/// Of fields over an open grid, which the state says. `largest` is any field with the same grid, energies and
/// mask.
StateFormulas FormulasOfFields(const UavWorld& largest, const UavFieldsLayout& layout, Formulas& formulas);

}  // namespace fresco
