// A line or a few on standard error that say how far work is: rewritten in place on a terminal, otherwise
// written again every few seconds. Used by one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace fresco {

/// How long work goes on if it stays as fast as since its first report.
class TimeLeft {
 public:
  /// Reports that `done` of `all` parts are done, by the monotonic clock. Returns "about 30 s left"; "" while
  /// it can't be known, and at the end.
  std::string Report(double done, double all, int64_t now_us);

 private:
  struct Progress {
    double done;
    int64_t at_us;
  };
  std::optional<Progress> first_;
};

class LiveLine {
 public:
  /// Not enabled, it shows nothing.
  explicit LiveLine(bool enabled);
  ~LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  /// Whether texts are rewritten in place at present: a process may go to the background and come back.
  bool on_terminal() const;
  /// Whether Show would show a text now, or leave it out since it comes too soon after another.
  bool IsDue() const;
  /// Shows the text, without a line end at its end. On a terminal, lines are cut to its width, and those that
  /// do not fit on it are left out.
  void Show(const std::string& text);
  /// Ends the text, so that other output begins on a line of its own.
  void Finish();

 private:
  bool enabled_;
  size_t open_lines_ = 0;  // of the text that the next one replaces
  int64_t next_us_ = 0;
};

}  // namespace fresco
