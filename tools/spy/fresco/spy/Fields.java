package fresco.spy;

import fresco.flight_t;
import fresco.scenario_t;
import java.util.Arrays;
import java.util.Map;

/** Joins scenario_t messages to the fields of the latest runs. Used on the event thread. */
final class Fields {
  private static final int REMEMBERED_RUNS = 16;
  static final int MAXIMUM_SLOTS = 10_000;
  private static final int MAXIMUM_CELLS_A_SIDE = 1000;
  private static final double LARGEST = 1e9; // metres, joules

  private static final class Parts {
    final Field.Sensor[] sensors;
    final byte[] cells; // 0: not known yet

    Parts(int sensors, int cells) {
      this.sensors = new Field.Sensor[sensors];
      this.cells = new byte[cells];
    }

    boolean areComplete() {
      boolean complete = !Arrays.asList(sensors).contains(null);
      for (int i = 0; complete && i < cells.length; ++i) {
        complete = cells[i] != 0;
      }
      return complete;
    }
  }

  private final Map<Long, Parts> parts = new RecentMap<>(REMEMBERED_RUNS);
  private final Map<Long, Field> fields = new RecentMap<>(REMEMBERED_RUNS);

  /** Returns the run's field; null if some part of it is not known yet. */
  Field of(long runId) { return fields.get(runId); }

  void add(scenario_t message) {
    if (!isSound(message)) {
      return;
    }
    Parts known = parts.get(message.run_id);
    if (known == null || known.sensors.length != message.total_sensors
        || known.cells.length != message.total_cells) {
      known = new Parts(message.total_sensors, message.total_cells);
      parts.put(message.run_id, known);
    }
    for (int i = 0; i < message.sensor_count; ++i) {
      known.sensors[message.first_sensor + i] =
          new Field.Sensor(message.x_m[i], message.y_m[i], message.weight[i]);
    }
    System.arraycopy(message.cell_kind, 0, known.cells, message.first_cell, message.cell_count);
    if (known.areComplete()) {
      fields.put(message.run_id, fieldOf(message, known));
    }
  }

  private static Field fieldOf(scenario_t message, Parts known) {
    return new Field(message.columns, message.rows, message.cell_m,
        new Field.Cell(message.start_column, message.start_row),
        new Field.Cell(message.stop_column, message.stop_row), message.slots, message.coverage_radius_m,
        message.initial_energy_j, Arrays.asList(known.sensors.clone()),
        known.cells.length == 0 ? Obstacles.NONE : new Obstacles(message.columns, known.cells.clone()));
  }

  private static boolean isSound(scenario_t message) {
    return isWithin(message.columns, 1, MAXIMUM_CELLS_A_SIDE)
        && isWithin(message.rows, 1, MAXIMUM_CELLS_A_SIDE) && isWithin(message.cell_m, 1e-6, LARGEST)
        && isWithin(message.start_column, 0, message.columns - 1)
        && isWithin(message.start_row, 0, message.rows - 1)
        && isWithin(message.stop_column, 0, message.columns - 1)
        && isWithin(message.stop_row, 0, message.rows - 1)
        && isWithin(message.slots, 1, MAXIMUM_SLOTS)
        && isWithin(message.coverage_radius_m, 0, LARGEST)
        && isWithin(message.initial_energy_j, 0, Double.MAX_VALUE) && sensorsAreSound(message)
        && cellsAreSound(message);
  }

  private static boolean sensorsAreSound(scenario_t message) {
    boolean sound = isWithin(message.total_sensors, 1, flight_t.MAXIMUM_SENSOR_COUNT)
        && isWithin(message.first_sensor, 0, message.total_sensors - message.sensor_count);
    for (int i = 0; sound && i < message.sensor_count; ++i) {
      sound = isWithin(message.x_m[i], -LARGEST, LARGEST) && isWithin(message.y_m[i], -LARGEST, LARGEST)
          && isWithin(message.weight[i], 0, LARGEST);
    }
    return sound;
  }

  private static boolean cellsAreSound(scenario_t message) {
    boolean sound = (message.total_cells == 0 || message.total_cells == message.columns * message.rows)
        && isWithin(message.first_cell, 0, message.total_cells - message.cell_count);
    for (int i = 0; sound && i < message.cell_count; ++i) {
      sound = Obstacles.isKind(message.cell_kind[i]);
    }
    return sound;
  }

  private static boolean isWithin(double value, double low, double high) {
    return value >= low && value <= high; // false for NaN
  }
}
