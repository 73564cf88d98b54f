#include "tests/bench/alternate.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/bench/stop.h"

namespace fresco {
namespace {

constexpr double kMicrosecondsPerSecond = 1e6;

double SpeedOfTurn(const Work& work, int64_t turn_us, const std::function<int64_t()>& clock_us) {
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

int64_t Microseconds(double seconds) {
  return std::llround(kMicrosecondsPerSecond * seconds);
}

}  // namespace

Speeds Alternate(const Work& value, const std::vector<Work>& references, double seconds,
                 const std::function<int64_t()>& clock_us) {
  constexpr int64_t kTurnUs = 10'000;
  constexpr int64_t kFewestRounds = 5;
  const int64_t for_each_us = Microseconds(seconds) / (1 + std::ssize(references));
  const int64_t turn_us = std::clamp<int64_t>(for_each_us / kFewestRounds, 1, kTurnUs);
  const int64_t end_us = clock_us() + Microseconds(seconds);
  Speeds speeds{0, std::vector<double>(references.size())};
  value();
  for (const Work& work : references) {
    work();
  }
  for (int64_t round = 0; round < kFewestRounds || clock_us() < end_us; ++round) {
    speeds.value = std::max(speeds.value, SpeedOfTurn(value, turn_us, clock_us));
    for (size_t i = 0; i < references.size(); ++i) {
      speeds.references[i] = std::max(speeds.references[i], SpeedOfTurn(references[i], turn_us, clock_us));
    }
  }
  return speeds;
}

double SpeedOf(const Work& work, double seconds, const std::function<int64_t()>& clock_us) {
  return SpeedOfTurn(work, Microseconds(seconds), clock_us);
}

}  // namespace fresco
