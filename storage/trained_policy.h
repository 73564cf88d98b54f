// A trained policy in a program of one's own, in five lines (examples/consumer/act.cc):
//   fresco::TrainedPolicy policy("runs/NAME");
//   const auto environment = policy.world().NewEnvironment();
//   environment->Reset(0);
//   while (environment->Step(policy.Act(*environment)).ending == fresco::Ending::kNone) {
//   }
// Only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "storage/network_file.h"

namespace fresco {

class TrainedPolicy {
 public:
  /// Reads the folder of a run (its best network), a network file or a checkpoint (its best network so far).
  /// Throws UsageError that says what a policy can be if `policy` is none of these or can't be read.
  explicit TrainedPolicy(const std::string& policy);

  /// The world that it was trained in; valid as long as this object.
  const World& world() const { return network_.experiment.world(); }
  const StoredNetwork& network() const { return network_; }

  /// The allowed action with the greatest value in the present state of an environment of world().
  int Act(const Environment& environment);
  /// The same in any state: its fields in the order of WorldDescription::state, and 1 for each allowed
  /// action, otherwise 0. CHECKs the sizes and that an action is allowed.
  int Act(std::span<const float> state, std::span<const uint8_t> mask);

  /// The value Q(s, a) of every action, also of forbidden ones, in the state of the last Act.
  std::span<const float> values() const;

 private:
  StoredNetwork network_;
  std::unique_ptr<NetworkWorkspace> workspace_;
  std::vector<float> state_;
  std::vector<uint8_t> mask_;
};

}  // namespace fresco
