// Draws a learning curve with characters, for a terminal. A pure function; any thread may call it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fresco {

/// An evaluation during a training.
struct TextCurvePoint {
  double updates = 0;  ///< >= 0
  double score = 0;    ///< finite
  double best = 0;     ///< the best score so far, finite
};

struct TextCurve {
  std::string title;                     ///< what the scores are, with their unit
  std::vector<TextCurvePoint> points{};  ///< at least one; CHECKs that updates rise
  std::optional<double> optimum{};       ///< drawn as a line; none if it is not known
  int columns = 60;                      ///< of the drawing without its labels, >= 2
  int rows = 8;                          ///< of the drawing, >= 2
};

/// Returns lines: the title, `rows` lines with '*' for the best score so far, '.' for evaluations that are
/// worse and '-' for the optimum, and the axis of the updates. Evaluations far above or below the best
/// scores are left out, so that these fill the drawing.
std::string Draw(const TextCurve& curve);

}  // namespace fresco
