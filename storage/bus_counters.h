// What happened to messages: for summary.json's `bus`, the status and checkpoints. Plain values.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace fresco {

struct BusCounters {
  int64_t received = 0;                  ///< messages of this run
  int64_t lost = 0;                      ///< orders whose result had to be asked for again
  int64_t duplicate = 0;                 ///< transitions messages that brought nothing new
  int64_t rejected = 0;                  ///< sum of the causes below
  int64_t rejected_malformed = 0;        ///< does not decode, or values out of range
  int64_t rejected_foreign = 0;          ///< another run, another configuration, an order never written
  int64_t rejected_inconsistent = 0;     ///< an episode that does not follow from its actions
  int64_t rejected_arithmetic = 0;       ///< statuses of actors whose arithmetic differs
  int64_t rejected_unauthenticated = 0;  ///< made with another key, or with none
  int64_t reordered_episodes = 0;        ///< complete before an earlier one
  int64_t stale_statuses = 0;            ///< of actors: not newer than the last one of the same actor
  int64_t crowded_statuses = 0;          ///< of actors beyond Roster::kMaximumActors
  int64_t weights_chunks_sent = 0;
  int64_t weights_chunks_repeated = 0;  ///< of those sent: asked for again
};

/// Every counter with its name, in the order above.
struct BusCounterField {
  const char* name;
  int64_t BusCounters::*value;
};
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

/// Names that are none are left out; what is not named is 0.
inline BusCounters FromMap(const std::map<std::string, int64_t>& map) {
  BusCounters counters;
  for (const BusCounterField& field : kBusCounterFields) {
    const auto found = map.find(field.name);
    counters.*field.value = found == map.end() ? 0 : found->second;
  }
  return counters;
}

}  // namespace fresco
