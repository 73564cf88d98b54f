package fresco.spy;

import java.util.List;

/** What a run's world is called, and all that is in it, from checked world_t messages. Immutable. */
record WorldNames(String world, List<Quantity> state, List<String> actions, List<Quantity> figures,
    boolean lessIsBetter, String success, int longestEpisode) {
  private static final int UAV_FIELDS = 4; // before the ages

  /** Returns the figure that episodes are compared by. */
  Quantity score() {
    return figures.get(0);
  }

  /** Whether its episodes are flights of the UAV over a field of sensors. */
  boolean isUav() {
    return world.equals("uav") && state.size() > UAV_FIELDS;
  }
}
