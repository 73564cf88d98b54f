// A decorator for tests and soak runs: loses, repeats, delays (reorders) and corrupts the messages
// that pass, by a seeded counter-based stream, so that a disturbance can be had again.
#pragma once

#include "bus/bus.h"

namespace fresco {

/// Probabilities in [0, 1] for each published message.
struct LossOptions {
  double drop = 0;
  double duplicate = 0;
  double delay = 0;    ///< held back until 1 to 16 further messages have been published
  double corrupt = 0;  ///< one bit flipped
  uint64_t seed = 1;
};

/// From "drop=0.01,duplicate=0.02,delay=0.05,corrupt=0.001,seed=3", any of them. Throws UsageError naming
/// the part that is wrong.
LossOptions ParseLossOptions(const std::string& text);
/// The text that ParseLossOptions reads.
std::string ToText(const LossOptions& options);

/// Disturbs what is published through it; subscriptions and polling pass through. `inner` must outlive it.
std::unique_ptr<Bus> MakeLossyBus(Bus& inner, LossOptions options);
/// The same with a bus of its own.
std::unique_ptr<Bus> MakeLossyBus(std::unique_ptr<Bus> inner, LossOptions options);

}  // namespace fresco
