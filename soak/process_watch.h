// Measures the memory and the open descriptors of processes on this host, from /proc. Any thread may call the
// functions; only one thread may use a ProcessWatch.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fresco {

struct ProcessUse {
  int64_t resident_kib = 0;  ///< resident memory now
  int64_t peak_kib = 0;      ///< the most resident memory so far
  int descriptors = 0;       ///< open descriptors
};

/// A process: its program's name, its parent, and what it uses.
struct ProcessState {
  std::string program;  ///< at most 15 characters
  pid_t parent = 0;
  ProcessUse use;
};

/// Reads the state of a process; none if there is no such process.
std::optional<ProcessState> ReadProcess(pid_t pid);

/// Returns processes that should have ended: children of this process, and learners whose command line names
/// something in `folder`. Each is "PROGRAM (process PID)".
std::vector<std::string> ProcessesLeftBehind(const std::filesystem::path& folder);

/// Returns the half-written files anywhere in `folder`.
std::vector<std::string> FilesLeftBehind(const std::filesystem::path& folder);

/// By program: the most that any process of the program used.
using UseByProgram = std::map<std::string, ProcessUse>;

/// Raises each number in `maxima` to that in `other` if the latter is larger.
void Include(const UseByProgram& other, UseByProgram& maxima);

class ProcessWatch {
 public:
  /// Measures these processes and this one. Does nothing if the last measurement was less than 0.2 s ago.
  void Look(const std::vector<pid_t>& pids);

  const UseByProgram& maxima() const { return maxima_; }

 private:
  UseByProgram maxima_;
  int64_t next_us_ = 0;
};

}  // namespace fresco
