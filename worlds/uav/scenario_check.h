// Checks that the values of a scenario are in range. Errors name a field as the text format of configurations
// does. World and the radio formulas call these. Pure functions; any thread may call them.
#pragma once

#include <string_view>

#include "worlds/uav/scenario.h"

namespace fresco {

/// The largest initial energy and the largest energy of a slot, joules. It keeps energy margins finite as the
/// floats that messages carry.
inline constexpr double kMaximumEnergyJ = 1e12;

/// Throws UsageError "<path>: <value> is out of range; allowed: <low> to <high>" unless low <= value <= high.
/// Also throws if the value is NaN.
void RequireWithin(std::string_view path, double value, double low, double high);

/// Throws UsageError if a value of the radio or slot_s is out of range, or if 2^(M / (B tau)) is too large.
void CheckRadio(const Radio& radio, double slot_s);

/// Throws UsageError if a value of the scenario is out of range, if the UAV's speed does not take it exactly
/// one cell a slot, or if there are too few slots to reach the stop. (World checks whether the energy
/// suffices.) Errors count sensors from 0, as Protobuf does: "scenario.sensor[2].weight".
void CheckScenario(const Scenario& scenario);

}  // namespace fresco
