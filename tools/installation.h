// Where the other programs and the ready experiments of this installation are.
#pragma once

#include <filesystem>
#include <string>

namespace fresco {

/// A program that stands beside this one: fresco-learner, fresco-actor.
std::filesystem::path SiblingProgram(const std::string& name);

/// A file of this installation that is the same on every host, share/fresco/<name>: the jars of `fresco spy`.
/// Throws UsageError where it is not there.
std::string SharedFile(const std::string& name);

/// A ready experiment, configs/<name>, of the source tree or the installation; throws UsageError where
/// there is none.
std::string ConfigPath(const std::string& name);

/// The one that is used where none is named: quick.textproto.
inline std::string DefaultConfigPath() {
  return ConfigPath("quick.textproto");
}

}  // namespace fresco
