package fresco.spy;

/**
 * A complete episode in any world. Immutable (nobody writes to the arrays).
 *
 * @param states the fields of each state; one more than there are actions
 * @param ending how it ended, as in transitions_t
 */
record Episode(long runId, long order, long actorId, long seed, WorldNames names, float[][] states,
    short[] actions, float[] rewards, int ending) {
  private static final int TERMINAL = 1;

  int steps() {
    return actions.length;
  }

  /** Returns the sum of all rewards. */
  double sumOfRewards() {
    double sum = 0;
    for (float reward : rewards) {
      sum += reward;
    }
    return sum;
  }

  String endingName() {
    return ending == TERMINAL ? "in a terminal state" : "cut off (truncated)";
  }

  String actor() {
    return String.format("actor %016x", actorId);
  }
}
