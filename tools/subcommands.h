// The subcommands of `fresco`, in the order of `fresco --help`. Each adds itself to the command line
// and runs when it is chosen; its result is the exit status.
#pragma once

#include <functional>

#include "core/command_line.h"

namespace fresco {

/// What to run once the command line is parsed.
using Command = std::function<int()>;

void AddTrain(CLI::App& app, Command& command);
void AddEvaluate(CLI::App& app, Command& command);
void AddRetrain(CLI::App& app, Command& command);
void AddFly(CLI::App& app, Command& command);
void AddFigures(CLI::App& app, Command& command);
void AddSoak(CLI::App& app, Command& command);
void AddLog(CLI::App& app, Command& command);
void AddSpy(CLI::App& app, Command& command);

}  // namespace fresco
