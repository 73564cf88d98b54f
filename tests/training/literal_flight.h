// A flyer's choices and errors once more, in double precision and plain loops.
#pragma once

#include <vector>

#include "tests/nn/literal_network.h"
#include "tests/training/acting_samples.h"
#include "worlds/uav/flight.h"

namespace fresco {

using Mask = std::vector<uint8_t>;

/// What single precision may change in a value.
inline constexpr double kValueRounding = 1e-5;

/// Standard deviations that a number of random choices may be off.
inline constexpr double kDeviations = 5;

/// Q(s, .) of a network.
Doubles LiteralValues(const Experiment& experiment, const Vector& parameters, const UavState& state);

/// The allowed action of the largest value; the first of equal ones.
int LiteralArgmax(const Doubles& values, const Mask& mask);

/// How far the best allowed value is above the second best; infinite with one allowed action.
double Lead(const Doubles& values, const Mask& mask);

/// The mask in each of the episode's states, from flying its actions again.
std::vector<Mask> MasksOf(const Experiment& experiment, const Episode& episode);

/// y - Q(s, a) of a transition; `next_mask` is that of s'.
double LiteralTdError(const Experiment& experiment, const FlightPlan& plan, const Episode& episode,
                      int transition, const Mask& next_mask);

}  // namespace fresco
