// Debian's gnuplot as a filter: a script goes in, a picture comes out. Thread-safe: every call runs a
// process of its own.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fresco {

inline constexpr int64_t kGnuplotTimeoutUs = 60'000'000;

/// What gnuplot writes to its standard output on `script`; no user's or system's settings have a part in
/// it. Throws Failure where the program is not in PATH (naming its Debian package), where it reports an
/// error (with its own words), and where it takes longer than `timeout_us`, which ends it.
std::string RunGnuplot(const std::string& script, int64_t timeout_us = kGnuplotTimeoutUs);

/// `text` as a string of a script. Nothing in it is special to gnuplot (the terminal must be
/// `noenhanced`); what a picture can't show becomes a space (line ends, control characters) or U+FFFD
/// (bytes that are not UTF-8).
std::string GnuplotString(std::string_view text);

}  // namespace fresco
