// Where the other programs and the files of this installation are, relative to the program that runs; so an
// installation can be moved. A build tree is laid out like an installation.
#pragma once

#include <filesystem>
#include <string>

namespace fresco {

/// How this program was called, for commands that a person is told to type.
std::string ProgramName();

/// A program that stands beside this one: fresco-learner, fresco-actor. Throws UsageError if it can't be run.
std::filesystem::path SiblingProgram(const std::string& name);

/// The folder of the files that are the same on every host, share/fresco: ready experiments, the jars of
/// `fresco spy`.
std::filesystem::path SharedFolder();

/// Throws UsageError unless a program of this name is in PATH. `package` is the Debian package that has it.
void RequireProgram(const std::string& name, const std::string& package);

}  // namespace fresco
