#include "report/text_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace fresco {

std::string Draw(const TextCurve& curve) {
  FRESCO_CHECK(!curve.points.empty() && curve.columns >= 2 && curve.rows >= 2);
  FRESCO_CHECK(
      std::is_sorted(curve.points.begin(), curve.points.end(),
                     [](const TextCurvePoint& a, const TextCurvePoint& b) { return a.updates < b.updates; }));
  const auto worse_best = [](const TextCurvePoint& a, const TextCurvePoint& b) { return a.best < b.best; };
  const auto [least, most] = std::minmax_element(curve.points.begin(), curve.points.end(), worse_best);
  double low = std::min(least->best, curve.optimum.value_or(least->best));
  double high = std::max(most->best, curve.optimum.value_or(most->best));
  if (!(low < high)) {
    low -= 0.5;
    high += 0.5;
  }
  const double first = curve.points.front().updates;
  const double width = std::max(curve.points.back().updates - first, 1.0);
  const auto column_of = [&](double updates) {
    return static_cast<int>(std::lround((updates - first) / width * (curve.columns - 1)));
  };
  const auto row_of = [&](double score) {
    return static_cast<int>(std::lround((high - score) / (high - low) * (curve.rows - 1)));
  };
  std::vector<std::string> lines(static_cast<size_t>(curve.rows),
                                 std::string(static_cast<size_t>(curve.columns), ' '));
  const auto set = [&](int row, int column, char character) {
    if (row >= 0 && row < curve.rows && column >= 0 && column < curve.columns) {
      lines[static_cast<size_t>(row)][static_cast<size_t>(column)] = character;
    }
  };
  if (curve.optimum) {
    lines[static_cast<size_t>(row_of(*curve.optimum))].assign(static_cast<size_t>(curve.columns), '-');
  }
  for (const TextCurvePoint& point : curve.points) {
    if (point.score > low - (high - low) && point.score < high + (high - low)) {
      set(row_of(point.score), column_of(point.updates), '.');
    }
  }
  for (size_t i = 0; i < curve.points.size(); ++i) {  // each best score lasts until the next evaluation
    const TextCurvePoint& point = curve.points[i];
    const int next = i + 1 < curve.points.size() ? column_of(curve.points[i + 1].updates) : curve.columns;
    for (int column = column_of(point.updates); column < std::max(next, column_of(point.updates) + 1);
         ++column) {
      set(row_of(point.best), column, '*');
    }
  }
  constexpr int kLabelColumns = 9;
  std::string text = curve.title + "\n";
  for (int row = 0; row < curve.rows; ++row) {
    const double score = high - (high - low) * row / (curve.rows - 1);
    const bool labelled = row == 0 || row == curve.rows - 1;
    text += fmt::format("{:>{}} |{}\n", labelled ? fmt::format("{:.4g}", score) : "", kLabelColumns,
                        lines[static_cast<size_t>(row)]);
  }
  const std::string begin = fmt::format("{:.0f}", first);
  const std::string end = fmt::format("{:.0f} updates", curve.points.back().updates);
  const int between = std::max(curve.columns - static_cast<int>(begin.size() + end.size()), 1);
  return text + std::string(kLabelColumns + 2, ' ') + begin + std::string(static_cast<size_t>(between), ' ') +
         end + "\n";
}

}  // namespace fresco
