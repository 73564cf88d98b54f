// The table of worlds: every kind of world that a configuration can name. How to add one is in
// CONTRIBUTING.md. Any thread may call these functions.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "msgs/proto/experiment.pb.h"
#include "msgs/wire.h"
#include "worlds/world.h"

namespace fresco {

class Experiment;

/// Whether the world of a configuration is described by files that it names (scenario.map). The
/// configuration may be incomplete.
bool NamesFiles(const proto::ExperimentConfig& config);
/// Replaces the names of such files by what is in them. They count from `folder`, or, if they are not there,
/// from the working directory. Throws UsageError naming field, file and what is wrong.
void ReadFiles(proto::ExperimentConfig& config, const std::filesystem::path& folder);

/// Sets what the configuration leaves out of its world and Protobuf's field defaults can't express; without
/// any world, the paper's.
void CompleteWorld(proto::ExperimentConfig& config);

/// The path of code that is not Fresco's and that the world of a configuration would run: a library, or a
/// Python module's file. Empty if there is none. The configuration may be incomplete.
std::string CodeOf(const proto::ExperimentConfig& config);

/// Makes the world of a complete configuration whose ranges were checked. Throws UsageError if its values do
/// not fit together, or if another part of the configuration asks for what this world does not have.
std::shared_ptr<const World> MakeWorld(const proto::ExperimentConfig& config);

/// Whether viewers get messages of the experiment's episodes: of the field (FRESCO_SCENARIO) and of the
/// flight (FRESCO_FLIGHT).
bool HasFlights(const Experiment& experiment);
/// The messages of the world's field; none if !HasFlights or every episode has another one. The caller fills
/// in `utime`, `run_id` and `config_hash`.
std::vector<scenario_t> ScenarioMessages(const Experiment& experiment);
/// The messages of the field of an episode. CHECKs HasFlights.
std::vector<scenario_t> ScenarioMessages(const Experiment& experiment, const Episode& episode);
/// The messages of an episode, one for each of its states. The caller fills in `utime`, `run_id`,
/// `config_hash` and `flight`. CHECKs HasFlights.
std::vector<flight_t> FlightMessages(const Experiment& experiment, const Episode& episode,
                                     const std::string& policy);

}  // namespace fresco
