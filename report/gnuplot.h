// Runs Debian's gnuplot on a script and returns the picture. Any thread may call these functions; every call
// runs a process of its own.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fresco {

inline constexpr int64_t kGnuplotTimeoutUs = 60'000'000;

/// Runs gnuplot on `script` without any settings of the user or the system, and returns its standard output.
/// Throws Failure if gnuplot is not in PATH (the error names its Debian package), if gnuplot reports an error
/// (the error quotes it), or if it takes longer than `timeout_us`; it is killed then.
std::string RunGnuplot(const std::string& script, int64_t timeout_us = kGnuplotTimeoutUs);

/// Returns `text` as a quoted string for a script, in which no character is special to gnuplot (the terminal
/// must be `noenhanced`). Characters that a picture can't show become spaces (line ends, control characters)
/// or U+FFFD (bytes that are not UTF-8).
std::string GnuplotString(std::string_view text);

}  // namespace fresco
