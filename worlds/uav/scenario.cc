#include "worlds/uav/scenario.h"

#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace fresco {

double HorizontalDistance(Cell cell, double cell_m, const Sensor& sensor) {
  const double x_m = cell.column * cell_m - sensor.x_m;
  const double y_m = cell.row * cell_m - sensor.y_m;
  return std::sqrt(x_m * x_m + y_m * y_m);
}

std::vector<Sensor> RandomSensors(int columns, int rows, double cell_m, int count, uint64_t seed) {
  FRESCO_CHECK(count >= 0);
  RandomStream stream(seed, RandomPurpose::kSensorPlacement, 0, 0);
  std::vector<Sensor> sensors(static_cast<size_t>(count));
  for (Sensor& sensor : sensors) {
    sensor.x_m = (stream.NextUniform() * columns - 0.5) * cell_m;
    sensor.y_m = (stream.NextUniform() * rows - 0.5) * cell_m;
  }
  return sensors;
}

}  // namespace fresco
