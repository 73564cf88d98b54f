#include "core/live_line.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/clock.h"
#include "core/utf8.h"

namespace fresco {
namespace {

winsize TerminalSize() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
  return known ? size : winsize{.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
}

/// Whether standard error is a terminal whose lines can be rewritten. A process in the background leaves the
/// lines of others alone.
bool CanRewrite() {
  const char* kind = std::getenv("TERM");
  const pid_t foreground = tcgetpgrp(STDERR_FILENO);  // -1: of a terminal without jobs
  return isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb" &&
         (foreground == -1 || foreground == getpgrp());
}

/// The text's lines, as many and as much of them as the terminal can show.
std::vector<std::string> VisibleLines(const std::string& text) {
  const winsize size = TerminalSize();
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; lines.size() + 1 < size.ws_row && std::getline(stream, line);) {
    lines.push_back(std::string(FirstCharacters(line, size.ws_col - 1U)));
  }
  return lines;
}

}  // namespace

std::string TimeLeft::Report(double done, double all, int64_t now_us) {
  constexpr double kLeastPassedS = 1;
  if (!first_) {
    first_ = {done, now_us};
  }
  const double passed_s = 1e-6 * static_cast<double>(now_us - first_->at_us);
  if (!(done > first_->done && done < all && passed_s > kLeastPassedS)) {
    return "";
  }
  const double seconds = passed_s / (done - first_->done) * (all - done);
  return seconds < 90 ? fmt::format("about {:.0f} s left", seconds)
                      : fmt::format("about {:.0f} min left", seconds / 60);
}

LiveLine::LiveLine(bool enabled) : enabled_(enabled) {}

bool LiveLine::on_terminal() const {
  return CanRewrite();
}

LiveLine::~LiveLine() {
  Finish();
}

bool LiveLine::IsDue() const {
  return enabled_ && MonotonicMicroseconds() >= next_us_;
}

void LiveLine::Show(const std::string& text) {
  constexpr int64_t kTerminalPeriodUs = 100'000;
  constexpr int64_t kPlainPeriodUs = 5'000'000;
  if (!IsDue()) {
    return;
  }
  const bool rewrites = on_terminal();
  next_us_ = MonotonicMicroseconds() + (rewrites ? kTerminalPeriodUs : kPlainPeriodUs);
  if (rewrites) {
    const std::vector<std::string> lines = VisibleLines(text);
    const std::string to_first_line = open_lines_ > 1 ? fmt::format("\x1b[{}A", open_lines_ - 1) : "";
    fmt::print(stderr, "{}\r\x1b[J{}", to_first_line, fmt::join(lines, "\n"));
    open_lines_ = lines.size();
  } else {
    Finish();
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

void LiveLine::Finish() {
  if (open_lines_ > 0) {
    fmt::print(stderr, "\n");
    open_lines_ = 0;
  }
}

}  // namespace fresco
