// An experiment is a configuration that was read, completed with the paper's values, and checked. All other
// code may rely on its ranges. Immutable after construction; any thread may use it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "msgs/proto/experiment.pb.h"
#include "nn/network.h"
#include "worlds/world.h"

namespace fresco {

/// Settings of single fields as (path, value), for example {"schedule.seed", "3"}; later ones win. A setting
/// of another world than the configuration's is an error.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Splits each path=value of the command line: {"schedule.seed=3"} becomes {{"schedule.seed", "3"}}. Throws
/// UsageError if the path or the '=' is missing.
Settings ParseSettings(const std::vector<std::string>& arguments);

/// Limits of a network's size. An actor receives its configuration from the bus, so no configuration may take
/// more memory than a machine has: a program holds some dozens of versions of the parameters at a time, and
/// the activations (outputs of all units) of one batch.
inline constexpr int64_t kMaximumParameters = 10'000'000;
inline constexpr int64_t kMaximumActivations = 40'000'000;
inline constexpr int kMaximumHiddenLayers = 16;

class Experiment {
 public:
  /// Parses Protobuf's text format, applies the settings, fills in defaults and checks everything. `origin`
  /// names the source in errors: a file, or "the run's configuration". Throws UsageError that names origin,
  /// field, value and what is allowed. The text may not name files (scenario.map), since it may come from the
  /// bus; settings may.
  static Experiment Parse(const std::string& text, const std::string& origin, const Settings& settings = {});
  /// Does the same with the text of a file, and reads the files that it names. Also throws UsageError if a
  /// file can't be read.
  static Experiment Load(const std::string& path, const Settings& settings = {});
  /// Does the same with a configuration message that the program built; there are no settings to apply.
  static Experiment Make(proto::ExperimentConfig config, const std::string& origin);

  /// The path of code that is not Fresco's and that the world of a configuration (its text) would run; empty
  /// if there is none. Whoever gets a configuration from the bus asks before Parse, which runs this code in
  /// another process. Throws UsageError if the text does not parse.
  static std::string CodeIn(const std::string& text, const std::string& origin);

  const proto::ExperimentConfig& config() const { return config_; }
  const proto::Agent& agent() const { return config_.agent(); }
  const proto::Schedule& schedule() const { return config_.schedule(); }
  const proto::Run& run() const { return config_.run(); }
  /// The world. It lives as long as this object or a copy of it.
  const World& world() const { return *world_; }

  /// The network of this experiment: from an observation of the world to values of its actions. Never null.
  const std::shared_ptr<const Network>& network() const { return network_; }
  /// The field of the configuration that gives the network its size, for errors.
  const char* network_field() const {
    return agent().has_set_network() ? "agent.set_network" : "agent.hidden_layers";
  }

  /// The complete configuration in text format, with every default written out.
  std::string Text() const;
  /// The part of the configuration that defines the world, in text format.
  std::string WorldText() const;
  /// The part of the configuration that decides the weights (world, agent, schedule), in text format.
  std::string CanonicalText() const;
  /// CRC-32C of CanonicalText(); never 0. Messages carry it as `config_hash`.
  uint32_t hash() const { return hash_; }

  /// The same experiment, but its training starts from these parameters; sets agent.start_crc32c, from which
  /// the hash follows. CHECKs their number.
  Experiment StartingFrom(std::shared_ptr<const Vector> parameters) const;
  /// The parameters given to StartingFrom; null without.
  const std::shared_ptr<const Vector>& start() const { return start_; }
  /// The parameters with which the training begins: start(), or random ones that follow from schedule.seed.
  /// Throws UsageError if agent.start_crc32c is set, but start() is null or has another CRC.
  Vector FirstParameters() const;

 private:
  uint32_t ComputeHash() const;

  proto::ExperimentConfig config_;
  std::shared_ptr<const World> world_;
  std::shared_ptr<const Network> network_;
  std::shared_ptr<const Vector> start_;
  uint32_t hash_ = 0;
};

}  // namespace fresco
