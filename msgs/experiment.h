// An experiment: a configuration that was read, completed with the paper's values and checked.
// Everything else may rely on its ranges. Immutable after construction; thread-safe.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "msgs/proto/experiment.pb.h"
#include "nn/mlp.h"
#include "worlds/uav/environment.h"
#include "worlds/uav/network_input.h"
#include "worlds/uav/scenario.h"

namespace fresco {

/// path=value settings, in order: {"schedule.seed", "3"}.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// An actor takes its configuration from the network: what it says must fit memory. Some dozens of versions
/// of a network are held at a time, and the outputs of all its units for a batch.
inline constexpr int64_t kMaximumParameters = 10'000'000;
inline constexpr int64_t kMaximumActivations = 40'000'000;
inline constexpr int kMaximumHiddenLayers = 16;

class Experiment {
 public:
  /// Parses text format, applies the settings, fills in defaults and checks everything. `origin`
  /// names the source in errors: a file, or "the run's configuration". Throws UsageError naming
  /// origin, field, value and what is allowed.
  static Experiment Parse(const std::string& text, const std::string& origin, const Settings& settings = {});
  static Experiment Load(const std::string& path, const Settings& settings = {});
  /// The same from a configuration that was put together in the program.
  static Experiment Make(proto::ExperimentConfig config, const std::string& origin);

  const proto::ExperimentConfig& config() const { return config_; }
  const proto::Agent& agent() const { return config_.agent(); }
  const proto::Schedule& schedule() const { return config_.schedule(); }
  const proto::Run& run() const { return config_.run(); }
  const Scenario& scenario() const { return scenario_; }

  /// The network of this experiment: inputs as NetworkInput has them, outputs 5 (N + 1).
  MlpShape network_shape() const;
  NetworkInputOptions network_input_options() const { return {agent().sensor_geometry()}; }
  MaskOptions mask_options() const;

  /// The complete configuration in text format.
  std::string Text() const;
  /// What decides the weights (scenario, agent, schedule), in text format.
  std::string CanonicalText() const;
  /// CRC-32C of CanonicalText(); never 0.
  uint32_t hash() const { return hash_; }

 private:
  proto::ExperimentConfig config_;
  Scenario scenario_;
  uint32_t hash_ = 0;
};

}  // namespace fresco
