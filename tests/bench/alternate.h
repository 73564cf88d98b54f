// Measures pieces of work in turns, so that what else the machine does hits all of them alike. Used by the
// main thread.
#pragma once

#include <functional>
#include <vector>

#include "core/clock.h"

namespace fresco {

/// Does some work and returns how much: updates, steps, bytes. Takes 10 microseconds or more.
using Work = std::function<double()>;

/// Amounts of work a second.
struct Speeds {
  double value = 0;
  std::vector<double> references;
};

/// Does `value`, then each of `references`, then `value` again, and so on for about `seconds`: five turns for
/// each, of which the fastest counts. `value` gets half of the time, `references` share the other half. Every
/// piece of work is done once before the first turn.
Speeds Alternate(const Work& value, const std::vector<Work>& references, double seconds,
                 const std::function<int64_t()>& clock_us = MonotonicMicroseconds);

}  // namespace fresco
