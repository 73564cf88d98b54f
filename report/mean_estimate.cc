#include "report/mean_estimate.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace fresco {

double StudentQuantile(double probability, int degrees_of_freedom) {
  FRESCO_CHECK(probability > 0 && probability < 1 && degrees_of_freedom >= 1);
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), probability);
}

MeanEstimate EstimateMean(std::span<const double> sample, double confidence) {
  FRESCO_CHECK(!sample.empty());
  FRESCO_CHECK(confidence > 0 && confidence < 1);
  const auto n = static_cast<double>(sample.size());
  MeanEstimate estimate{.mean = std::accumulate(sample.begin(), sample.end(), 0.0) / n, .half_width = {}};
  FRESCO_CHECK(std::isfinite(estimate.mean));
  if (sample.size() == 1) {
    return estimate;
  }
  double squares = 0;
  for (const double value : sample) {
    squares += (value - estimate.mean) * (value - estimate.mean);
  }
  const double standard_error = std::sqrt(squares / (n - 1) / n);
  const double t = StudentQuantile((1 + confidence) / 2, static_cast<int>(sample.size()) - 1);
  estimate.half_width = t * standard_error;
  return estimate;
}

}  // namespace fresco
