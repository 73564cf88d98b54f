// What a soak holds a round against, and what it finds. Each check returns sentences, none where all is
// well. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "soak/process_watch.h"

namespace fresco {

/// What a run came to; equal for every run of a configuration, whatever happens to it.
struct RunFacts {
  std::string weights_crc32c;  ///< of the final network
  std::string final_network;   ///< final.network, byte for byte
  int64_t episodes = 0;
  int64_t transitions = 0;
  int64_t updates = 0;
  int64_t total_aoi = 0;  ///< of the best evaluated version; -1: none arrived
};

/// Of a complete run's folder. Throws where a file is missing or is not what the learner writes.
RunFacts ReadRunFacts(const std::filesystem::path& folder);
/// Whether the run in the folder came to its end.
bool IsComplete(const std::filesystem::path& folder);

/// What a disturbed run has that the undisturbed one has not.
std::vector<std::string> Differences(const RunFacts& undisturbed, const RunFacts& disturbed);

/// Programs that used more than the undisturbed run's: peak memory beyond 1.25 times and the allowance, or
/// more than a few descriptors.
std::vector<std::string> Excesses(const UseByProgram& undisturbed, const UseByProgram& disturbed,
                                  int64_t memory_allowance_kib);

/// What a series gained from its first value to its last along its trend: the median of all slopes between
/// two values (Theil and Sen), so that neither noise nor a single step counts. 0 for fewer than four.
double Growth(const std::vector<double>& series);

/// Growth of this program over the rounds, one value after each: memory by more than the allowance,
/// descriptors by more than two.
std::vector<std::string> Leaks(const std::vector<ProcessUse>& after_rounds, int64_t memory_allowance_kib);

}  // namespace fresco
