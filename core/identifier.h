// Names for runs and actors, drawn from the system's random device. They tell processes apart and have no
// influence on what is flown or learned; everything else random comes from core/random.h. Thread-safe.
#pragma once

#include <cstdint>

namespace fresco {

/// Positive; two draws are the same with a probability of about 2^-62.
int64_t DrawIdentifier();

}  // namespace fresco
