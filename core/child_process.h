// A child process that never outlives its parent. Only one thread at a time may use an object.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fresco {

class ChildProcess {
 public:
  /// What the child gets as its standard streams: open descriptors, which stay the caller's.
  struct Streams {
    int input;
    int output;
    int errors;
  };

  /// Its exit status if the program does not exist or can't be run.
  static constexpr int kCannotRun = 127;

  /// Starts the program `arguments[0]`: a path, or a name that is looked up in PATH. It gets a process group
  /// of its own, so a terminal's Ctrl-C reaches the parent only, and SIGTERM if the thread that started it
  /// ends. Throws Failure if no process can be made.
  ChildProcess(const std::vector<std::string>& arguments, const Streams& streams);
  /// Does the same with standard output and error appended to `log`. Throws Failure if that can't be written.
  ChildProcess(const std::vector<std::string>& arguments, const std::filesystem::path& log);
  /// Kills the process, and all that it has started, if it is still running.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  int64_t started_us() const { return started_us_; }

  /// Returns the exit status if the process has ended: 0.., or 128 + the signal that ended it.
  std::optional<int> ExitStatus();
  /// Waits for the end. Returns the exit status; none if the process is still running after `timeout_us`.
  std::optional<int> Wait(int64_t timeout_us);

  void Signal(int signal_number);
  /// Sends SIGTERM, then does WaitForEnd.
  int End(int64_t patience_us);
  /// Waits for the end of a process that was told to end before; a second SIGTERM would kill it. Kills it if
  /// it is still running after `patience_us`. Returns its exit status.
  int WaitForEnd(int64_t patience_us);

 private:
  void Kill();

  pid_t pid_ = -1;
  int64_t started_us_ = 0;
  std::optional<int> exit_status_;
};

/// Returns the last lines of a log, for error messages, each after a line feed; empty if there is no log.
std::string LastLines(const std::filesystem::path& log, int lines);

}  // namespace fresco
