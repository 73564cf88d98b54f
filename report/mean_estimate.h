// Estimates of a mean from a sample, with a confidence interval. Pure functions; any thread may call them.
#pragma once

#include <optional>
#include <span>

namespace fresco {

struct MeanEstimate {
  double mean = 0;
  /// Half the width of the two-sided Student-t confidence interval around the mean, in the sample's unit.
  /// None if the sample has a single value, since that says nothing about the spread.
  std::optional<double> half_width;
};

/// Estimates the mean of a sample of at least one value; all values must be finite. `confidence`, between 0
/// and 1, is the probability of the interval. half_width = t_{(1 + confidence) / 2, n - 1} s / sqrt(n), where
/// s is the standard deviation with n - 1 in its denominator.
MeanEstimate EstimateMean(std::span<const double> sample, double confidence = 0.95);

/// Returns the quantile of Student's t distribution for a probability between 0 and 1. `degrees_of_freedom`
/// is at least 1.
double StudentQuantile(double probability, int degrees_of_freedom);

}  // namespace fresco
