#include "worlds/uav/scenario.h"

#include "core/error.h"
#include "core/random.h"

namespace fresco {

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
