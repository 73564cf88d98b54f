// The installation that the running program belongs to: its version, and where its other programs and files
// are, relative to the program; so an installation can be moved. A build tree is laid out like an
// installation. Any thread may call these functions.
#pragma once

#include <filesystem>
#include <string>

namespace fresco {

/// The software's version, written into files and shown by --version.
extern const char* const kSoftwareVersion;

/// The commit that this program was built from, as `git describe` names it; "unknown" if it was built outside
/// of Fresco's repository. Only programs have it (cmake/FrescoCommit.cmake), so no library may use it.
extern const char* const kSourceCommit;

/// How this program was called, for commands that a person is told to type.
std::string ProgramName();

/// A program in the folder of this one: fresco-learner, fresco-actor. Throws UsageError if it can't be run.
std::filesystem::path SiblingProgram(const std::string& name);

/// The folder of the files that are the same on every host, share/fresco: ready experiments, the jars of
/// `fresco spy`.
std::filesystem::path SharedFolder();

/// The folder of the libraries that programs load when they need them, lib/fresco.
std::filesystem::path LibraryFolder();

/// Throws UsageError unless a program of this name is in PATH. `package` is the Debian package that has it.
void RequireProgram(const std::string& name, const std::string& package);

}  // namespace fresco
