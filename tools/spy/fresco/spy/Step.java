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

  private static final int HOVER = 4;
  // Where each field is in a state of the UAV's world (worlds/uav/uav_world.h).
  private static final int COLUMN = 0;
  private static final int ROW = 1;
  private static final int TIME_MARGIN = 2;
  private static final int ENERGY_MARGIN = 3;
  private static final int AOI = 4;

  /** Returns a state of an episode of the UAV's world, and what was done there; in the last one, nothing. */
  static Step of(Episode episode, int index) {
    float[] state = episode.states()[index];
    short[] aoi = new short[state.length - AOI];
    for (int n = 0; n < aoi.length; ++n) {
      aoi[n] = (short) state[AOI + n];
    }
    int schedules = aoi.length + 1;
    int action = index < episode.steps() ? episode.actions()[index] : HOVER * schedules;
    return new Step(index + 1, (int) state[COLUMN], (int) state[ROW], aoi, action / schedules,
        action % schedules, (int) state[TIME_MARGIN], state[ENERGY_MARGIN], Double.NaN);
  }

  /** Returns how a flight has ended that ends here, by the margins. */
  int outcome() {
    return timeMargin < 0 ? Flight.OUT_OF_TIME : energyMarginJ < 0 ? Flight.OUT_OF_ENERGY : Flight.ARRIVED;
  }

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
