#include "worlds/uav/aoi_figures.h"

#include <algorithm>

#include "core/error.h"

namespace fresco {
namespace {

/// Adds up the ages of slots t = 1, 2, ...
struct AoiSums {
  int64_t total = 0;
  double weighted = 0;

  void Add(const World& world, std::span<const int16_t> aoi) {
    for (size_t sensor = 0; sensor < aoi.size(); ++sensor) {
      total += aoi[sensor];
      weighted += world.theta()[sensor] * aoi[sensor];
    }
  }
};

}  // namespace

AoiFigures Figures(const World& world, const Episode& episode) {
  const int slots = world.scenario().slots;
  const int cap = world.scenario().maximum_aoi.value_or(slots);
  FRESCO_CHECK(!episode.states.empty() && episode.states.size() <= static_cast<size_t>(slots));
  AoiSums sums;
  for (const State& state : episode.states) {
    sums.Add(world, state.aoi);
  }
  std::vector<int16_t> aoi = episode.states.back().aoi;
  for (auto slot = static_cast<int>(episode.states.size()); slot < slots; ++slot) {
    for (int16_t& value : aoi) {
      value = static_cast<int16_t>(std::min(value + 1, cap));
    }
    sums.Add(world, aoi);
  }
  return {sums.total, sums.weighted / slots, static_cast<double>(sums.total) / slots};
}

double GapPercent(double average_aoi, double least_average_aoi) {
  return 100 * (average_aoi - least_average_aoi) / least_average_aoi;
}

}  // namespace fresco
