// The subcommands of `fresco log`, in the order of `fresco log --help`. They work like those in
// tools/subcommands.h.
#pragma once

#include "tools/subcommands.h"

namespace fresco {

void AddLogRecord(CLI::App& log, Command& command);
void AddLogInfo(CLI::App& log, Command& command);
void AddLogCat(CLI::App& log, Command& command);
void AddLogCut(CLI::App& log, Command& command);
void AddLogExport(CLI::App& log, Command& command);
void AddLogPlay(CLI::App& log, Command& command);

}  // namespace fresco
