// What a soak found: as a table, as JSON, and its faults one by one. Pure.
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
  std::string disturbance;  ///< of its messages, as --disturb takes it
  RoundResult result;
  std::string repeat;  ///< the command that has this round again
};

struct SoakReport {
  uint64_t seed = 0;
  std::filesystem::path folder;
  double wall_s = 0;
  RoundResult undisturbed;
  std::vector<SoakRoundReport> rounds;
  std::vector<ProcessUse> after_rounds;  ///< of the soak's own process
  std::vector<std::string> failures;     ///< not of one round
  bool interrupted = false;

  /// Whether at least one round was compared and nothing whatever was found.
  bool passed() const;
};

/// Tables for people, with what failed and how to have it again.
std::string SoakText(const SoakReport& report);

/// One JSON object.
std::string SoakJson(const SoakReport& report);

/// soak.csv: one row a fault.
std::vector<std::string> FaultHeader();
std::vector<std::vector<CsvCell>> FaultRows(const SoakReport& report);

}  // namespace fresco
