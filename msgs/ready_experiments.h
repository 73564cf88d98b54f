// The ready experiments that are installed with Fresco, and what --config means: one rule for every program.
#pragma once

#include <string>
#include <vector>

namespace fresco {

/// The experiment that is run if none is named.
inline constexpr char kDefaultExperiment[] = "quick";

/// Their names, in alphabetical order: {"ci", "paper", ...}. Empty if this installation has none.
std::vector<std::string> ReadyExperiments();

/// The file that `config` stands for: a path that exists stands for itself; otherwise NAME, NAME.textproto
/// and configs/NAME.textproto stand for the ready experiment NAME. Throws UsageError that lists them if
/// `config` is neither.
std::string ExperimentPath(const std::string& config);

/// The help of --config: the rule in short, the ready experiments and what holds without the option.
std::string ConfigHelp(const std::string& without_it = kDefaultExperiment);

}  // namespace fresco
