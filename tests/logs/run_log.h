// Makes the LCM event log that a recorder would have written of a small run, which was flown in this process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/training/literal_run.h"

namespace fresco {

/// An event that owns its bytes.
struct OwnedEvent {
  int64_t utime = 0;
  std::string channel;
  std::vector<std::byte> message;
};

inline RunIdentity Identity(const RecordedRun& run, int64_t run_id = 77) {
  return {run_id, run.experiment.hash()};
}

/// Returns everything that the run's learner and actor would have sent, in order: the configuration, the
/// names of the world, orders, episodes in messages of transitions, and the first chunk of each version of
/// the networks.
std::vector<OwnedEvent> EventsOf(const RecordedRun& run, RunIdentity identity);

void WriteLog(const std::filesystem::path& path, const std::vector<OwnedEvent>& events);

}  // namespace fresco
