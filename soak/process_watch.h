// What processes of this host take of it, from /proc: memory and open descriptors. Used by one thread.
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
  int64_t resident_kib = 0;
  int64_t peak_kib = 0;  ///< the most that was ever resident
  int descriptors = 0;
};

/// A process's program, as /proc names it, and what it uses.
struct ProcessState {
  std::string program;  ///< at most 15 characters
  pid_t parent = 0;
  ProcessUse use;
};

/// None where there is no such process.
std::optional<ProcessState> ReadProcess(pid_t pid);

/// Processes that ought to have ended: children of this one, and learners whose command line names
/// something in `folder`. Each as "PROGRAM (process PID)".
std::vector<std::string> ProcessesLeftBehind(const std::filesystem::path& folder);

/// Half-written files anywhere in `folder`.
std::vector<std::string> FilesLeftBehind(const std::filesystem::path& folder);

/// The most that any process of a program used, by program.
using UseByProgram = std::map<std::string, ProcessUse>;

/// Takes the maximum of both, figure by figure.
void Include(const UseByProgram& other, UseByProgram& maxima);

class ProcessWatch {
 public:
  /// Looks at the processes and at this one, at most every 0.2 s.
  void Look(const std::vector<pid_t>& pids);

  const UseByProgram& maxima() const { return maxima_; }

 private:
  UseByProgram maxima_;
  int64_t next_us_ = 0;
};

}  // namespace fresco
