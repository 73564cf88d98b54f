// The program `fresco`, which tools/fresco builds and runs.
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "core/command_line.h"
#include "core/error.h"
#include "core/signals.h"
#include "core/version.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

int Main(int argc, char** argv) {
  CLI::App app("Fresco trains a UAV to keep the data of a sensor field fresh.", "fresco");
  app.set_version_flag("--version", kSoftwareVersion);
  app.require_subcommand(1);
  Command command;
  AddTrain(app, command);
  AddEvaluate(app, command);
  AddRetrain(app, command);
  AddFly(app, command);
  AddFigures(app, command);
  AddSoak(app, command);
  AddLog(app, command);
  AddSpy(app, command);
  app.footer("Exit status: 0 done, 1 the work failed, 2 wrong use.");
  return ParseCommandLine(app, argc, argv) ? command() : 0;
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("fresco"));
  spdlog::set_pattern("%n: %l: %v");
  fresco::StopSignal::Install();
  try {
    return fresco::Main(argc, argv);
  } catch (const fresco::Error& error) {
    spdlog::error("{}", error.what());
    return error.exit_status();
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
