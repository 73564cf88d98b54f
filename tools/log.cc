#include "tools/log_commands.h"

namespace fresco {

void AddLog(CLI::App& app, Command& command) {
  CLI::App* log = app.add_subcommand("log", "Record, inspect, cut, export and play logs of the traffic");
  log->require_subcommand(1);
  AddLogRecord(*log, command);
  AddLogInfo(*log, command);
  AddLogCat(*log, command);
  AddLogCut(*log, command);
  AddLogExport(*log, command);
  AddLogPlay(*log, command);
}

}  // namespace fresco
