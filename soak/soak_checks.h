// Compares a round of a soak with the undisturbed run. Each check returns sentences that describe problems,
// and none if there are none. Any thread may call these functions; only ReadRunFacts and IsComplete read
// files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "soak/process_watch.h"

namespace fresco {

/// The results of a run that must be equal for every run of a configuration, whatever happens to it.
struct RunFacts {
  std::string weights_crc32c;  ///< of the final network
  std::string final_network;   ///< final.network, byte for byte
  int64_t episodes = 0;
  int64_t transitions = 0;
  int64_t updates = 0;
  int64_t total_aoi = 0;  ///< of the best evaluated version; -1: none was evaluated
};

/// Reads the folder of a complete run. Throws if a file is missing or damaged.
RunFacts ReadRunFacts(const std::filesystem::path& folder);
/// Whether the folder holds a complete run.
bool IsComplete(const std::filesystem::path& folder);

/// Returns the differences between the results of the two runs.
std::vector<std::string> Differences(const RunFacts& undisturbed, const RunFacts& disturbed);

/// Returns the programs that used much more under faults than undisturbed: more peak memory than 1.25 times
/// plus the allowance, or more than a few additional descriptors.
std::vector<std::string> Excesses(const UseByProgram& undisturbed, const UseByProgram& disturbed,
                                  int64_t memory_allowance_kib);

/// Returns how much a series grew along its trend from the first value to the last. The slope of the trend is
/// the median of the slopes between any two values (Theil and Sen), so noise and single steps do not count.
/// Returns 0 for fewer than four values.
double Growth(const std::vector<double>& series);

/// Checks the growth of this program, with one measurement after each round: reports memory that grew by more
/// than the allowance, and descriptors that grew by more than two.
std::vector<std::string> Leaks(const std::vector<ProcessUse>& after_rounds, int64_t memory_allowance_kib);

}  // namespace fresco
