// The one exception type of Fresco, thrown at start-up and by file access; never by what arrives
// from the network, which is counted instead. The text says what was expected, what was found,
// where (file, field or channel), and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace fresco {

/// What went wrong, as far as the exit status of a program is concerned.
enum class ErrorKind {
  kFailure = 1,  ///< the work failed: exit status 1
  kUsage = 2,    ///< wrong use: command line, configuration, address; exit status 2
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  ErrorKind kind() const { return kind_; }
  int exit_status() const { return static_cast<int>(kind_); }

 private:
  ErrorKind kind_;
};

/// An Error of kind kFailure.
inline Error Failure(const std::string& message) {
  return {ErrorKind::kFailure, message};
}

/// An Error of kind kUsage.
inline Error UsageError(const std::string& message) {
  return {ErrorKind::kUsage, message};
}

/// Throws UsageError "origin: problem" unless the condition holds: what reads files checks them with it.
inline void Expect(bool condition, const std::string& origin, const std::string& problem) {
  if (!condition) {
    throw UsageError(origin + ": " + problem);
  }
}

}  // namespace fresco
