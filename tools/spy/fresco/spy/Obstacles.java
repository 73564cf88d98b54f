package fresco.spy;

/**
 * The map of a field: a character for each cell, as scenario_t has it. Immutable. A field without obstacles has
 * one without cells.
 */
record Obstacles(int columns, byte[] kinds) {
  static final Obstacles NONE = new Obstacles(0, new byte[0]);
  private static final int PARTS = 1 << 16; // of a cell

  char kindOf(int cell) { return (char) kinds[cell]; }

  static boolean isKind(byte kind) { return ".NRBS".indexOf(kind) >= 0; }

  /**
   * Whether radio passes between the UAV over a cell and a sensor: the line between them does not go through the
   * inside of a cell that blocks radio, other than the one in which the sensor stands. The rule is that of
   * worlds/uav/obstacle_map.h.
   */
  boolean haveLineOfSight(int column, int row, Field.Sensor sensor, double cellM) {
    long x = (long) column * PARTS;
    long y = (long) row * PARTS;
    long sensorX = (long) Math.floor(sensor.xM() / cellM * PARTS + 0.5);
    long sensorY = (long) Math.floor(sensor.yM() / cellM * PARTS + 0.5);
    long standsIn = Math.floorDiv(sensorY + PARTS / 2 - 1, PARTS) * columns
        + Math.floorDiv(sensorX + PARTS / 2 - 1, PARTS);
    for (int cell = 0; cell < kinds.length; ++cell) {
      boolean blocks = kindOf(cell) == 'R' || kindOf(cell) == 'B';
      if (blocks && cell != standsIn && crosses(x, y, sensorX, sensorY, cell)) {
        return false;
      }
    }
    return true;
  }

  /** Whether a line goes through the inside of a cell: neither an edge nor the line itself separates them. */
  private boolean crosses(long x, long y, long endX, long endY, int cell) {
    long west = (long) (cell % columns) * PARTS - PARTS / 2;
    long south = (long) (cell / columns) * PARTS - PARTS / 2;
    if (Math.max(x, endX) <= west || Math.min(x, endX) >= west + PARTS || Math.max(y, endY) <= south
        || Math.min(y, endY) >= south + PARTS) {
      return false;
    }
    int left = 0;
    int right = 0;
    for (int corner = 0; corner < 4; ++corner) {
      long cornerX = west + (corner & 1) * PARTS;
      long cornerY = south + (corner >> 1) * PARTS;
      long side = (endX - x) * (cornerY - y) - (endY - y) * (cornerX - x);
      left += side > 0 ? 1 : 0;
      right += side < 0 ? 1 : 0;
    }
    return left > 0 && right > 0 || x == endX && y == endY;
  }
}
