// Makes the report of a soak: as text, as JSON, and as a table of its faults. Pure functions; any thread may
// call them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/csv.h"
#include "soak/soak_round.h"

namespace fresco {

struct SoakRoundReport {
  int number = 0;
  std::string disturbance;  ///< disturbance of its messages, in the form of --disturb
  RoundResult result;
  std::string repeat;  ///< the command that repeats this round
};

struct SoakReport {
  uint64_t seed = 0;
  std::filesystem::path folder;
  double wall_s = 0;
  RoundResult undisturbed;
  std::vector<SoakRoundReport> rounds;
  std::vector<ProcessUse> after_rounds;  ///< use of the soak's own process after each round
  std::vector<std::string> failures;     ///< failures that do not belong to one round
  bool interrupted = false;

  /// Whether at least one round was compared and there was no failure.
  bool passed() const;
};

/// Returns tables for people, with the failures and the commands that repeat their rounds.
std::string SoakText(const SoakReport& report);

/// Returns one JSON object.
std::string SoakJson(const SoakReport& report);

/// The header and the rows of soak.csv, one row for each fault.
std::vector<std::string> FaultHeader();
std::vector<std::vector<CsvCell>> FaultRows(const SoakReport& report);

}  // namespace fresco
