// The subcommands of `fresco log`, in the order of its help; as in tools/subcommands.h.
#pragma once

#include "tools/subcommands.h"

namespace fresco {

void AddLogRecord(CLI::App& log, Command& command);

}  // namespace fresco
