#include "core/live_line.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "core/clock.h"

namespace fresco {
namespace {

size_t TerminalWidth() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

LiveLine::LiveLine(bool enabled) : enabled_(enabled), terminal_(isatty(STDERR_FILENO) == 1) {}

LiveLine::~LiveLine() {
  Finish();
}

void LiveLine::Show(const std::string& text) {
  constexpr int64_t kTerminalPeriodUs = 100'000;
  constexpr int64_t kPlainPeriodUs = 5'000'000;
  const int64_t now_us = MonotonicMicroseconds();
  if (!enabled_ || now_us < next_us_) {
    return;
  }
  next_us_ = now_us + (terminal_ ? kTerminalPeriodUs : kPlainPeriodUs);
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[K{}", text.substr(0, TerminalWidth() - 1));
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

void LiveLine::Finish() {
  if (line_open_) {
    fmt::print(stderr, "\n");
    line_open_ = false;
  }
}

}  // namespace fresco
