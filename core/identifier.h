// Ids of runs and actors, and their form as text. Any thread may call these functions.
#pragma once

#include <cstdint>
#include <string>

namespace fresco {

/// Draws a positive id from the system's random device. Two draws are the same with a probability of about
/// 2^-62. Ids tell processes apart and have no influence on what is flown or learned; everything else random
/// comes from core/random.h.
int64_t DrawIdentifier();

/// Returns the id of a run or an actor as 16 hexadecimal digits, as all texts and files show it.
std::string IdentifierText(int64_t id);

/// Parses 1 to 16 hexadecimal digits as the id of a run. Throws UsageError for any other text, and for 0.
int64_t ParseRunId(const std::string& text);

}  // namespace fresco
