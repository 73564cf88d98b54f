#include "tests/bench/alternate.h"

#include <algorithm>

#include "tests/bench/stop.h"

namespace fresco {
namespace {

/// The speed of the work, repeated for `seconds`, but done once at least.
double SpeedOfTurn(const Work& work, double seconds, const std::function<int64_t()>& clock_us) {
  constexpr double kSecondsPerMicrosecond = 1e-6;
  const int64_t begin_us = clock_us();
  double amount = 0;
  double elapsed_s = 0;
  do {
    ThrowIfStopped();
    amount += work();
    elapsed_s = static_cast<double>(clock_us() - begin_us) * kSecondsPerMicrosecond;
  } while (elapsed_s < seconds);
  return amount / elapsed_s;
}

}  // namespace

Speeds Alternate(const Work& value, const std::vector<Work>& references, double seconds,
                 const std::function<int64_t()>& clock_us) {
  constexpr int kRounds = 5;
  const double turn_s = seconds / (2 * kRounds);
  Speeds speeds{0, std::vector<double>(references.size())};
  value();
  for (const Work& work : references) {
    work();
  }
  for (int round = 0; round < kRounds; ++round) {
    speeds.value = std::max(speeds.value, SpeedOfTurn(value, turn_s, clock_us));
    for (size_t i = 0; i < references.size(); ++i) {
      speeds.references[i] =
          std::max(speeds.references[i],
                   SpeedOfTurn(references[i], turn_s / static_cast<double>(references.size()), clock_us));
    }
  }
  return speeds;
}

}  // namespace fresco
