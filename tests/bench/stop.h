// The end of a measurement that somebody asked for. Any thread may call it.
#pragma once

#include "core/error.h"
#include "core/signals.h"

namespace fresco {

/// Throws Failure after Ctrl-C.
inline void ThrowIfStopped() {
  if (StopSignal::Requested()) {
    throw Failure("interrupted");
  }
}

}  // namespace fresco
