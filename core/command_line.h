// What the main function of every program does, and the command line: parsed so that wrong use is reported
// like every other error, with the name that was probably meant. Used by the main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace fresco {

/// How a program writes its log to standard error.
enum class LogStyle {
  kPlain,  ///< "fresco: info: text", for the program that a person calls
  kTimed,  ///< with time and process id, for a program that serves a run
};

/// What --version shows beside the version.
struct Build {
  std::string commit;           ///< kSourceCommit (core/installation.h)
  std::string arithmetic = {};  ///< that of networks, as chosen at the start; empty if it computes none
};

/// A program: its command line, log and signals.
class Program {
 public:
  /// `name` is the program's name in its log and in texts, `description` its purpose, for --help.
  Program(const std::string& name, const std::string& description, LogStyle style, const Build& build);

  /// Has --help and --version; the program adds its own options and commands.
  CLI::App& command_line() { return command_line_; }

  /// Sets up the log, handles SIGINT and SIGTERM (core/signals.h) and, if the style is kTimed, SIGUSR1,
  /// parses the command line and calls `run`. Logs what that throws. Returns the program's exit status. Call
  /// it before any thread is started.
  int Run(int argc, const char* const* argv, const std::function<int()>& run);

 private:
  CLI::App command_line_;
  LogStyle style_;
};

/// Parses. Returns false if help or the version was asked for: it is printed, and nothing is left to do.
/// Throws UsageError naming the command, what is wrong with it, and the nearest command or option if one does
/// not exist.
bool ParseCommandLine(CLI::App& app, int argc, const char* const* argv);

/// A check for an option's value: it is one of these names.
CLI::Validator OneOf(const std::vector<std::string>& names);

}  // namespace fresco
