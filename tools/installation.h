// Where the other programs and the ready experiments of this installation are.
#pragma once

#include <filesystem>
#include <string>

namespace fresco {

/// A program that stands beside this one: fresco-learner, fresco-actor.
std::filesystem::path SiblingProgram(const std::string& name);

/// configs/quick.textproto of the source tree or the installation; throws UsageError where there is none.
std::string DefaultConfigPath();

}  // namespace fresco
