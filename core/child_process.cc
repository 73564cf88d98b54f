#include "core/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

[[noreturn]] void RunChild(char* const* arguments, const ChildProcess::Streams& streams, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) {
    _exit(1);  // the parent died before the line above
  }
  dup2(streams.input, STDIN_FILENO);
  dup2(streams.output, STDOUT_FILENO);
  dup2(streams.errors, STDERR_FILENO);
  close_range(STDERR_FILENO + 1, ~0u, 0);  // LCM's sockets, which it leaves open to children
  execvp(arguments[0], arguments);
  dprintf(STDERR_FILENO, "can't start %s: %s\n", arguments[0], std::strerror(errno));
  _exit(ChildProcess::kCannotRun);
}

/// A log, open to be appended to.
class LogFile {
 public:
  explicit LogFile(const std::filesystem::path& path)
      : descriptor_(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)) {
    if (descriptor_ < 0) {
      throw Failure("can't write the log " + path.string() + ": " + std::strerror(errno));
    }
  }
  ~LogFile() { close(descriptor_); }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  ChildProcess::Streams streams() const { return {STDIN_FILENO, descriptor_, descriptor_}; }

 private:
  int descriptor_;
};

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const std::filesystem::path& log)
    : ChildProcess(arguments, LogFile(log).streams()) {}

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const Streams& streams)
    : started_us_(MonotonicMicroseconds()) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    RunChild(pointers.data(), streams, parent);
  }
  if (pid_ < 0) {
    throw Failure("can't start " + arguments.front() + ": " + std::strerror(errno));
  }
  setpgid(pid_, pid_);  // here, too, since Kill may come before the child has done it
}

ChildProcess::~ChildProcess() {
  if (!ExitStatus()) {
    Kill();
    waitpid(pid_, nullptr, 0);
  }
}

std::optional<int> ChildProcess::ExitStatus() {
  int status = 0;
  if (!exit_status_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    exit_status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  return exit_status_;
}

std::optional<int> ChildProcess::Wait(int64_t timeout_us) {
  constexpr int kWaitMs = 2;
  const int64_t begin_us = MonotonicMicroseconds();
  while (!ExitStatus() && MonotonicMicroseconds() - begin_us <= timeout_us) {
    poll(nullptr, 0, kWaitMs);
  }
  return exit_status_;
}

void ChildProcess::Signal(int signal_number) {
  if (!exit_status_) {
    kill(pid_, signal_number);
  }
}

int ChildProcess::End(int64_t patience_us) {
  Signal(SIGTERM);
  return WaitForEnd(patience_us);
}

int ChildProcess::WaitForEnd(int64_t patience_us) {
  if (!Wait(patience_us)) {
    Kill();
  }
  return *Wait(INT64_MAX);
}

/// Kills the whole process group.
void ChildProcess::Kill() {
  kill(-pid_, SIGKILL);
}

std::string LastLines(const std::filesystem::path& log, int lines) {
  std::ifstream stream(log);
  std::deque<std::string> last;
  for (std::string line; std::getline(stream, line);) {
    last.push_back(line);
    if (last.size() > static_cast<size_t>(lines)) {
      last.pop_front();
    }
  }
  std::string text;
  for (const std::string& line : last) {
    text += "\n  " + line;
  }
  return text;
}

}  // namespace fresco
