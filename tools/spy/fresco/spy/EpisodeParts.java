package fresco.spy;

import fresco.transitions_t;
import java.util.BitSet;
import java.util.HashMap;
import java.util.Map;

/**
 * The parts of one episode that have arrived: transitions, and fields of wide states. Used on the event
 * thread.
 */
final class EpisodeParts {
  private static final int ROW_COST = 40; // the memory of an empty row, as a number of fields

  /** A state and the transition that begins there. */
  private static final class Row {
    final float[] state;
    final BitSet arrived; // the fields of which the transition has arrived
    short action;
    float reward;

    Row(int width) {
      state = new float[width];
      arrived = new BitSet(width);
    }
  }

  private final WorldNames names;
  private final int width;
  private final long seed;
  private final Map<Integer, Row> rows = new HashMap<>();
  private long fieldsArrived;
  private int length; // transitions; 0: the end has not arrived
  private int ending;

  EpisodeParts(WorldNames names, long seed) {
    this.names = names;
    this.width = names.state().size();
    this.seed = seed;
  }

  /** Returns the memory it takes, as a number of fields. */
  long cost() { return (long) rows.size() * (width + ROW_COST); }

  /** Whether the message can be of the same episode. */
  boolean fits(transitions_t message, WorldNames world) {
    int end = message.first_transition + message.transition_count;
    boolean ends = message.ending != 0;
    return world == names && message.seed == seed && (length == 0 || end <= length)
        && !(ends && length != 0 && end != length) && !(ends && rows.containsKey(end + 1));
  }

  void take(transitions_t message) {
    for (int i = 0; i < message.state_count; ++i) {
      Row row = rows.computeIfAbsent(message.first_transition + i, any -> new Row(width));
      System.arraycopy(message.state[i], 0, row.state, message.first_field, message.field_count);
      if (i < message.transition_count) {
        int before = row.arrived.cardinality();
        row.arrived.set(message.first_field, message.first_field + message.field_count);
        fieldsArrived += row.arrived.cardinality() - before;
        row.action = message.action[i];
        row.reward = message.reward[i];
      }
    }
    if (message.ending != 0) {
      length = message.first_transition + message.transition_count;
      ending = message.ending;
    }
  }

  boolean isWhole() { return length > 0 && fieldsArrived == (long) length * width; }

  /** Returns the episode. Call it once it is whole. */
  Episode episode(transitions_t last) {
    float[][] states = new float[length + 1][];
    short[] actions = new short[length];
    float[] rewards = new float[length];
    for (int i = 0; i <= length; ++i) {
      Row row = rows.get(i);
      states[i] = row.state;
      if (i < length) {
        actions[i] = row.action;
        rewards[i] = row.reward;
      }
    }
    return new Episode(
        last.run_id, last.order_index, last.actor_id, seed, names, states, actions, rewards, ending);
  }
}
