#include "worlds/uav/aoi_figures.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/error.h"

namespace fresco {
namespace {

/// Adds up the ages of slots t = 1, 2, ...
struct AoiSums {
  int64_t total = 0;
  double weighted = 0;

  void Add(const UavWorld& world, std::span<const float> aoi) {
    for (size_t sensor = 0; sensor < aoi.size(); ++sensor) {
      total += static_cast<int64_t>(aoi[sensor]);
      weighted += world.theta()[sensor] * aoi[sensor];
    }
  }
};

}  // namespace

AoiFigures Figures(const UavWorld& world, const Episode& episode) {
  const int slots = world.scenario().slots;
  const auto cap = static_cast<float>(world.scenario().maximum_aoi.value_or(slots));
  FRESCO_CHECK(episode.transitions() < slots);
  FRESCO_CHECK(episode.state(0).size() == static_cast<size_t>(world.state_size()));
  AoiSums sums;
  for (size_t i = 0; i <= episode.actions.size(); ++i) {
    sums.Add(world, episode.state(i).subspan(kAoiField));
  }
  const auto last = episode.state(episode.actions.size()).subspan(kAoiField);
  std::vector<float> aoi(last.begin(), last.end());
  for (int slot = episode.transitions() + 1; slot < slots; ++slot) {
    for (float& value : aoi) {
      value = std::min(value + 1, cap);
    }
    sums.Add(world, aoi);
  }
  return {sums.total, sums.weighted / slots, static_cast<double>(sums.total) / slots};
}

}  // namespace fresco
