#include "learner/starvation_warning.h"

#include <fmt/format.h>

namespace fresco {

std::optional<std::string> StarvationWarning::Note(double starved_s, const std::string& waiting_for) {
  std::optional<std::string> line;
  if (starved_s < last_s_) {
    if (next_s_ > kFirstS) {
      line = fmt::format("a result arrived after {:.0f} s; the run continues", last_s_);
    }
    next_s_ = kFirstS;
  } else if (starved_s > next_s_) {
    line = fmt::format("no result for {:.0f} s: waiting for {}", starved_s, waiting_for);
    next_s_ = starved_s + kAgainS;
  }
  last_s_ = starved_s;
  return line;
}

}  // namespace fresco
