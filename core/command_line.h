// The command line of a program, parsed so that wrong use is reported like every other error, with the name
// that was probably meant.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace fresco {

/// Parses. Returns false if help or the version was asked for: it is printed, and nothing is left to do.
/// Throws UsageError naming the command, what is wrong with it, and the nearest command or option if one does
/// not exist.
bool ParseCommandLine(CLI::App& app, int argc, const char* const* argv);

/// A check for an option's value: it is one of these names.
CLI::Validator OneOf(const std::vector<std::string>& names);

}  // namespace fresco
