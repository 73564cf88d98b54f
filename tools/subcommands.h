// The subcommands of `fresco`. Each function adds its subcommand to the command line. If the user chooses it,
// parsing sets `command`, which returns the exit status. Used by the main thread.
#pragma once

#include <functional>

#include "core/command_line.h"

namespace fresco {

/// The function to run after the command line was parsed.
using Command = std::function<int()>;

// In the order of `fresco --help`.
void AddTrain(CLI::App& app, Command& command);
void AddEvaluate(CLI::App& app, Command& command);
void AddExport(CLI::App& app, Command& command);
void AddCompare(CLI::App& app, Command& command);
void AddRetrain(CLI::App& app, Command& command);
void AddFly(CLI::App& app, Command& command);
void AddFigures(CLI::App& app, Command& command);
void AddSoak(CLI::App& app, Command& command);
void AddLog(CLI::App& app, Command& command);
void AddWatch(CLI::App& app, Command& command);
void AddSpy(CLI::App& app, Command& command);
void AddDoctor(CLI::App& app, Command& command);
void AddBench(CLI::App& app, Command& command);

/// Throws UsageError that says what to install unless this host has what `fresco spy` needs.
void RequireSpy();

// Subcommands of `fresco log` that have a file of their own.
void AddLogRecord(CLI::App& log, Command& command);
void AddLogExport(CLI::App& log, Command& command);
void AddLogPlay(CLI::App& log, Command& command);

}  // namespace fresco
