package fresco.spy;

/**
 * One slot of a flight: the state at its beginning, and the action in it. Immutable (nobody writes to aoi).
 *
 * @param slot 1, 2, ..
 * @param aoi age of each sensor's data, slots
 * @param move 0 north, 1 south, 2 east, 3 west, 4 hover
 * @param scheduled 0 none, 1 .. N the sensor that sends its data
 * @param timeMargin slots beyond the distance to the stop
 * @param energyMarginJ joules beyond the flight to the stop
 * @param remainingEnergyJ on board; NaN if it is not known
 */
record Step(int slot, int column, int row, short[] aoi, int move, int scheduled, int timeMargin,
    double energyMarginJ, double remainingEnergyJ) {
  private static final String[] MOVES = {"north", "south", "east", "west", "hover"};

  String moveName() {
    return move >= 0 && move < MOVES.length ? MOVES[move] : "?";
  }

  /** Returns the largest AoI, at least 1. */
  int oldest() {
    int oldest = 1;
    for (short age : aoi) {
      oldest = Math.max(oldest, age);
    }
    return oldest;
  }

  long totalAoi() {
    long total = 0;
    for (short age : aoi) {
      total += age;
    }
    return total;
  }
}
