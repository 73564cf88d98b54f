// The bounds of a scenario's values, each error naming the field as it is called in the text
// format. Used by `World` and by the radio formulas; pure.
#pragma once

#include <string_view>

#include "worlds/uav/scenario.h"

namespace fresco {

/// Of a whole flight's and of a slot's energy: keeps every margin finite as the float that it is on the wire.
inline constexpr double kMaximumEnergyJ = 1e12;

/// Throws UsageError "<path>: <value> is out of range; allowed: <low> to <high>" unless the value
/// is in the closed interval (NaN never is).
void RequireWithin(std::string_view path, double value, double low, double high);

/// Checks the radio's values and slot_s: all finite and in range, and 2^(M / (B tau)) representable.
void CheckRadio(const Radio& radio, double slot_s);

/// Checks every value of a scenario, that the UAV's speed takes it one cell a slot, and that the
/// slots suffice to reach the stop. (World checks the energy, which it derives.) Sensors are
/// counted from 0 in the error's text, as protobuf does: "scenario.sensor[2].weight".
void CheckScenario(const Scenario& scenario);

}  // namespace fresco
