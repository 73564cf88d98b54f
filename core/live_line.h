// One line on standard error that says how long work is going: rewritten in place on a terminal,
// otherwise a plain line every few seconds. Used by one thread.
#pragma once

#include <cstdint>
#include <string>

namespace fresco {

class LiveLine {
 public:
  /// Not enabled, it shows nothing.
  explicit LiveLine(bool enabled);
  ~LiveLine();
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  /// Shows the text, cut to the terminal's width; texts that come too soon after another are left out.
  void Show(const std::string& text);
  /// Ends the line, so that other output begins on a line of its own.
  void Finish();

 private:
  bool enabled_;
  bool terminal_;
  bool line_open_ = false;
  int64_t next_us_ = 0;
};

}  // namespace fresco
