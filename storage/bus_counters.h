// Counts what happened to the learner's messages. The counters are in `bus` of summary.json, in the learner's
// status and in checkpoints. Plain values; pure functions.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace fresco {

struct BusCounters {
  int64_t received = 0;                  ///< messages of this run that were received
  int64_t lost = 0;                      ///< orders whose result had to be asked for again
  int64_t duplicate = 0;                 ///< messages of transitions that brought nothing new
  int64_t rejected = 0;                  ///< sum of the five counters below
  int64_t rejected_malformed = 0;        ///< messages that do not decode or have values out of range
  int64_t rejected_foreign = 0;          ///< of another run or configuration, or of an order never written
  int64_t rejected_inconsistent = 0;     ///< results whose episode does not follow from its actions
  int64_t rejected_arithmetic = 0;       ///< statuses of actors whose arithmetic differs
  int64_t rejected_unauthenticated = 0;  ///< messages made with another key, or with none
  int64_t reordered_episodes = 0;        ///< episodes that were complete before an earlier one
  int64_t stale_statuses = 0;            ///< statuses that are not newer than the actor's last one
  int64_t crowded_statuses = 0;          ///< statuses of actors beyond Roster::kMaximumActors
  int64_t weights_chunks_sent = 0;       ///< chunks of networks sent
  int64_t weights_chunks_repeated = 0;   ///< those of them that were sent again because an actor asked
};

/// A counter and its name.
struct BusCounterField {
  const char* name;
  int64_t BusCounters::*value;
};
/// Every counter, in the order above.
inline constexpr BusCounterField kBusCounterFields[] = {
    {"received", &BusCounters::received},
    {"lost", &BusCounters::lost},
    {"duplicate", &BusCounters::duplicate},
    {"rejected", &BusCounters::rejected},
    {"rejected_malformed", &BusCounters::rejected_malformed},
    {"rejected_foreign", &BusCounters::rejected_foreign},
    {"rejected_inconsistent", &BusCounters::rejected_inconsistent},
    {"rejected_arithmetic", &BusCounters::rejected_arithmetic},
    {"rejected_unauthenticated", &BusCounters::rejected_unauthenticated},
    {"reordered_episodes", &BusCounters::reordered_episodes},
    {"stale_statuses", &BusCounters::stale_statuses},
    {"crowded_statuses", &BusCounters::crowded_statuses},
    {"weights_chunks_sent", &BusCounters::weights_chunks_sent},
    {"weights_chunks_repeated", &BusCounters::weights_chunks_repeated},
};

inline std::map<std::string, int64_t> ToMap(const BusCounters& counters) {
  std::map<std::string, int64_t> map;
  for (const BusCounterField& field : kBusCounterFields) {
    map[field.name] = counters.*field.value;
  }
  return map;
}

/// Ignores names that are no counter's. Counters that the map does not name are 0.
inline BusCounters FromMap(const std::map<std::string, int64_t>& map) {
  BusCounters counters;
  for (const BusCounterField& field : kBusCounterFields) {
    const auto found = map.find(field.name);
    counters.*field.value = found == map.end() ? 0 : found->second;
  }
  return counters;
}

}  // namespace fresco
