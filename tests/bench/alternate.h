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

/// Does `value`, then each of `references`, then `value` again, and so on for about `seconds`. Every turn
/// takes 10 ms (less if there would be fewer than five of each, more if the work can't be done in parts), so
/// that an interruption is as likely in each; the fastest of a work's turns counts. Every work is done once
/// before that.
Speeds Alternate(const Work& value, const std::vector<Work>& references, double seconds,
                 const std::function<int64_t()>& clock_us = MonotonicMicroseconds);

/// The speed of a work that is repeated for `seconds`, but done once at least.
double SpeedOf(const Work& work, double seconds,
               const std::function<int64_t()>& clock_us = MonotonicMicroseconds);

}  // namespace fresco
