// The one exception type of Fresco. Start-up and file access throw it. What arrives from the network never
// does; it is counted instead. An error's text says what was expected, what was found, where (file, field or
// channel), and what to do. If a name does not exist, it says which one was probably meant. FRESCO_CHECK is
// for what only a programmer's error can break. Any thread may call these functions.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fresco {

/// What went wrong, as far as the exit status of a program is concerned.
enum class ErrorKind {
  kFailure = 1,  ///< the work failed: exit status 1
  kUsage = 2,    ///< wrong use: command line, configuration, address; exit status 2
  kPlugin = 3,   ///< code that is not Fresco's failed (plugins/fresco/world.h); exit status 3
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
Error Failure(const std::string& message);

/// An Error of kind kUsage.
Error UsageError(const std::string& message);

/// An Error of kind kPlugin.
Error PluginFailure(const std::string& message);

/// Throws UsageError "origin: problem" unless the condition holds: what reads files checks them with it.
void Expect(bool condition, const std::string& origin, const std::string& problem);

/// How many characters have to be inserted, removed, replaced, or swapped with their neighbour to make `to`
/// of `from`, if no character is edited twice (optimal string alignment).
size_t EditDistance(std::string_view from, std::string_view to);

/// The candidate with the fewest edits from `name`, the first of several; none if that takes edits in more
/// than a third of the characters. A candidate that begins or ends with `name` (three characters or more) is
/// near however long it is.
std::optional<std::string> NearestName(std::string_view name, const std::vector<std::string>& candidates);

/// For the end of an error's text: "; did you mean record?", or "" if no candidate is near.
std::string DidYouMean(std::string_view name, const std::vector<std::string>& candidates);

/// Prints and aborts; for FRESCO_CHECK.
[[noreturn]] void CheckFailed(const char* file, int line, const char* condition);

}  // namespace fresco

/// Aborts, in every build type, unless the condition holds. Bad input is never checked with it.
#define FRESCO_CHECK(condition)                                   \
  do {                                                            \
    if (!(condition)) [[unlikely]] {                              \
      ::fresco::CheckFailed(__FILE_NAME__, __LINE__, #condition); \
    }                                                             \
  } while (false)
