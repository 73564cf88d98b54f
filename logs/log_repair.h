// Saves what is sound of a damaged event log. Used by one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fresco {

struct LogRepair {
  struct Loss {
    enum class Kind {
      kDamaged,         ///< these bytes are no event
      kTorn,            ///< the log ends in the middle of an event
      kDamagedMessage,  ///< a whole event, but its message begins like one of Fresco's and does not decode
    };
    Kind kind;
    int64_t begin;  ///< position in the damaged log, bytes
    int64_t end;    ///< behind the last byte
    bool operator==(const Loss&) const = default;
  };

  static constexpr size_t kMaximumListed = 100;

  int64_t read_bytes = 0;  ///< all bytes of the damaged log
  int64_t events = 0;      ///< written to the new log
  int64_t bytes = 0;
  int64_t lost_bytes = 0;
  int64_t losses = 0;
  std::vector<Loss> listed = {};  ///< the first kMaximumListed of them, in the order of the log
};

/// Copies every whole event of `log` to a new log at `out`, but none with a damaged message of Fresco's.
/// Shows progress on standard error. Throws UsageError if `log` can't be read or has no whole event, or if
/// `out` exists; then it makes no file. Throws Failure if a file can't be read or written, or if the program
/// is asked to stop.
LogRepair RepairLog(const std::filesystem::path& log, const std::filesystem::path& out);

/// Returns lines for people: what was lost of `log`, and where.
std::string RepairText(const LogRepair& repair, const std::filesystem::path& log,
                       const std::filesystem::path& out);

}  // namespace fresco
