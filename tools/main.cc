// The program `fresco`, which tools/fresco builds and runs.
#include "core/installation.h"
#include "nn/arithmetic.h"
#include "tools/subcommands.h"

int main(int argc, char** argv) {
  using namespace fresco;
  Program program("fresco",
                  "Fresco trains agents over LCM with the same result to the bit, whatever happens.",
                  LogStyle::kPlain, {kSourceCommit, CurrentArithmetic().name});
  CLI::App& app = program.command_line();
  app.require_subcommand(1);
  Command command;
  AddTrain(app, command);
  AddEvaluate(app, command);
  AddExport(app, command);
  AddCompare(app, command);
  AddRetrain(app, command);
  AddFly(app, command);
  AddFigures(app, command);
  AddSoak(app, command);
  AddLog(app, command);
  AddWatch(app, command);
  AddSpy(app, command);
  AddDoctor(app, command);
  AddBench(app, command);
  app.footer(
      "See fresco COMMAND --help for the options of a command, with examples.\n"
      "Exit status: 0 done, 1 the work failed, 2 wrong use.");
  return program.Run(argc, argv, [&] { return command(); });
}
