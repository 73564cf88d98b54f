// The table of worlds: every kind of world that a configuration can name. How to add one is in
// CONTRIBUTING.md. Any thread may call these functions.
#pragma once

#include <memory>
#include <string>

#include "msgs/proto/experiment.pb.h"
#include "worlds/world.h"

namespace fresco {

/// Sets what the configuration leaves out of its world and Protobuf's field defaults can't express; without
/// any world, the paper's.
void CompleteWorld(proto::ExperimentConfig& config);

/// The path of code that is not Fresco's and that the world of a configuration would run: a library, or a
/// Python module's file. Empty if there is none. The configuration may be incomplete.
std::string CodeOf(const proto::ExperimentConfig& config);

/// Makes the world of a complete configuration whose ranges were checked. Throws UsageError if its values do
/// not fit together, or if another part of the configuration asks for what this world does not have.
std::shared_ptr<const World> MakeWorld(const proto::ExperimentConfig& config);

}  // namespace fresco
