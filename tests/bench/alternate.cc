#include "tests/bench/alternate.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/bench/stop.h"

namespace fresco {
namespace {

/// The speed of the work, repeated for so long, but done once at least.
double SpeedOfTurn(const Work& work, int64_t turn_us, const std::function<int64_t()>& clock_us) {
  constexpr double kMicrosecondsPerSecond = 1e6;
  const int64_t begin_us = clock_us();
  double amount = 0;
  int64_t elapsed_us = 0;
  do {
    ThrowIfStopped();
    amount += work();
    elapsed_us = clock_us() - begin_us;
  } while (elapsed_us < turn_us);
  return kMicrosecondsPerSecond * amount / static_cast<double>(elapsed_us);
}

}  // namespace

Speeds Alternate(const Work& value, const std::vector<Work>& references, double seconds,
                 const std::function<int64_t()>& clock_us) {
  constexpr int kRounds = 5;
  const int64_t turn_us = std::llround(1e6 * seconds / (2 * kRounds));
  const int64_t reference_turn_us = turn_us / std::max<int64_t>(1, std::ssize(references));
  Speeds speeds{0, std::vector<double>(references.size())};
  value();
  for (const Work& work : references) {
    work();
  }
  for (int round = 0; round < kRounds; ++round) {
    speeds.value = std::max(speeds.value, SpeedOfTurn(value, turn_us, clock_us));
    for (size_t i = 0; i < references.size(); ++i) {
      speeds.references[i] =
          std::max(speeds.references[i], SpeedOfTurn(references[i], reference_turn_us, clock_us));
    }
  }
  return speeds;
}

}  // namespace fresco
