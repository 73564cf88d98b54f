package fresco.spy;

import java.util.List;

/**
 * The field of a run, from checked scenario_t messages. Positions are in metres, east and north of the centre
 * of cell (0, 0). Immutable.
 */
record Field(int columns, int rows, double cellM, Cell start, Cell stop, int slots, double coverageRadiusM,
    double initialEnergyJ, List<Sensor> sensors, Obstacles obstacles) {
  record Cell(int column, int row) {}

  record Sensor(double xM, double yM, double weight) {}

  /** Returns theta_n: the weight of each sensor as a share of the sum. */
  double[] theta() {
    double sum = sensors.stream().mapToDouble(Sensor::weight).sum();
    return sensors.stream().mapToDouble(sensor -> sum > 0 ? sensor.weight() / sum : 0).toArray();
  }

  boolean onGrid(int column, int row) {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }

  /** Whether a UAV over the cell can collect from the sensor (0-based). */
  boolean covers(int column, int row, int sensor) {
    Sensor at = sensors.get(sensor);
    return Math.hypot(column * cellM - at.xM, row * cellM - at.yM) <= coverageRadiusM
        && obstacles.haveLineOfSight(column, row, at, cellM);
  }
}
