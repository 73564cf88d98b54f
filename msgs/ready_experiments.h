// Finds the experiments that are installed with Fresco, and decides what --config means, for every program
// alike. Reads the file system; any thread may call these functions.
#pragma once

#include <string>
#include <vector>

namespace fresco {

/// The experiment that runs if --config is not given.
inline constexpr char kDefaultExperiment[] = "quick";

/// The names of the installed experiments in alphabetical order, for example {"ci", "paper", ...}. Empty if
/// the installation has none.
std::vector<std::string> ReadyExperiments();

/// Returns the path of the file that `config` names. If there is such a file, it is that path. Otherwise
/// NAME, NAME.textproto and configs/NAME.textproto all mean the installed experiment NAME, even beside a folder
/// of that name. Throws UsageError that lists the installed experiments if `config` is none of all that.
std::string ExperimentPath(const std::string& config);

/// The help text of --config: the rule in short, the installed experiments, and the default (`without_it`).
std::string ConfigHelp(const std::string& without_it = kDefaultExperiment);

}  // namespace fresco
