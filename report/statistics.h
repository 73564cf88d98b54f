// What a sample says about its mean. Pure; may be called from any thread.
#pragma once

#include <optional>
#include <span>

namespace fresco {

struct MeanEstimate {
  double mean = 0;
  /// Half the width of the two-sided Student-t confidence interval around the mean, in the sample's
  /// unit; none for a single value, which says nothing about its spread.
  std::optional<double> half_width;
};

/// `confidence` is the probability of the interval, between 0 and 1. The values must be finite, and at
/// least one. half_width = t_{(1 + confidence) / 2, n - 1} s / sqrt(n), s with n - 1 in its denominator.
MeanEstimate EstimateMean(std::span<const double> sample, double confidence = 0.95);

/// The `probability` quantile (between 0 and 1) of Student's t distribution with at least one degree of
/// freedom.
double StudentQuantile(double probability, int degrees_of_freedom);

}  // namespace fresco
