// A bus for tests and soak runs that loses, repeats, delays (so reorders) and corrupts the messages that it
// publishes. It wraps another bus. The seed decides what happens to each message, so the same disturbance can
// be repeated. Threads may use it as they may use any bus.
#pragma once

#include "bus/bus.h"

namespace fresco {

/// Probabilities in [0, 1] for each published message.
struct LossOptions {
  double drop = 0;
  double duplicate = 0;
  double delay = 0;    ///< the message is held back until 1 to 16 further messages have been published
  double corrupt = 0;  ///< one bit of the message is flipped
  uint64_t seed = 1;
};

/// Parses "drop=0.01,duplicate=0.02,delay=0.05,corrupt=0.001,seed=3" or some of these parts. Throws
/// UsageError that names the wrong part.
LossOptions ParseLossOptions(const std::string& text);
/// Returns the text that ParseLossOptions reads.
std::string ToText(const LossOptions& options);

/// Returns a bus that disturbs the messages published through it. Receiving is not disturbed. `inner` must
/// outlive it.
std::unique_ptr<Bus> MakeLossyBus(Bus& inner, LossOptions options);
/// Does the same, and owns `inner`.
std::unique_ptr<Bus> MakeLossyBus(std::unique_ptr<Bus> inner, LossOptions options);

}  // namespace fresco
