// A child process that never outlives its parent, with its output in a log file.
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
  /// Starts `arguments[0]` in a process group of its own (a terminal's Ctrl-C reaches the parent
  /// only), standard output and error appended to `log`. Dies by SIGTERM where the parent dies.
  /// Throws Failure where it can't be started.
  ChildProcess(const std::vector<std::string>& arguments, const std::filesystem::path& log);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  int64_t started_us() const { return started_us_; }

  /// The exit status once it has ended: 0.. , or 128 + signal.
  std::optional<int> ExitStatus();

  /// SIGTERM, then WaitForEnd.
  int End(int64_t patience_us);
  /// SIGKILL where it is still there after `patience_us`. Returns its exit status. For a process that was
  /// told to end before: a second SIGTERM would kill it.
  int WaitForEnd(int64_t patience_us);
  void Signal(int signal_number);

 private:
  pid_t pid_ = -1;
  int64_t started_us_ = 0;
  std::optional<int> exit_status_;
};

/// The last `lines` lines of a log, for error messages; empty where there is none.
std::string LastLines(const std::filesystem::path& log, int lines);

}  // namespace fresco
