package fresco.spy;

import fresco.transitions_t;
import java.util.Map;
import java.util.TreeMap;

/** Joins transitions_t messages, in any order, to complete episodes. Used on the event thread. */
final class Episodes {
  private static final int OPEN_EPISODES = 256;
  private static final int REMEMBERED_EPISODES = 1024;

  private record Key(long runId, long order) {}

  private final Map<Key, TreeMap<Integer, transitions_t>> open = new RecentMap<>(OPEN_EPISODES);
  private final Map<Key, Boolean> done = new RecentMap<>(REMEMBERED_EPISODES);

  /** Returns the episode if the message completes one, otherwise null. */
  Flight add(transitions_t message) {
    Key key = new Key(message.run_id, message.order_index);
    if (!isSound(message) || done.containsKey(key)) {
      return null;
    }
    TreeMap<Integer, transitions_t> parts = open.computeIfAbsent(key, any -> new TreeMap<>());
    parts.put(message.first_transition, message);
    if (!isWhole(parts)) {
      return null;
    }
    open.remove(key);
    done.put(key, true);
    return flightOf(parts);
  }

  private static boolean isSound(transitions_t message) {
    return message.transition_count >= 1 && message.state_count == message.transition_count + 1
        && message.sensor_count >= 1 && message.first_transition >= 0
        && message.first_transition + message.transition_count < Fields.MAXIMUM_SLOTS;
  }

  private static boolean isWhole(TreeMap<Integer, transitions_t> parts) {
    int next = 0;
    for (transitions_t part : parts.values()) {
      if (part.first_transition != next || part.sensor_count != parts.firstEntry().getValue().sensor_count) {
        return false;
      }
      next += part.transition_count;
    }
    return parts.lastEntry().getValue().outcome != Flight.FLYING;
  }

  private static Flight flightOf(TreeMap<Integer, transitions_t> parts) {
    transitions_t last = parts.lastEntry().getValue();
    String actor = String.format("actor %016x", last.actor_id);
    Flight flight = new Flight(last.run_id, last.order_index, "episode", actor, false);
    flight.outcome = last.outcome;
    for (transitions_t part : parts.values()) {
      for (int i = 0; i < part.transition_count; ++i) {
        flight.steps.add(stepOf(part, i, part.action[i]));
      }
    }
    int hover = 4 * (last.sensor_count + 1);
    flight.steps.add(stepOf(last, last.transition_count, hover));
    return flight;
  }

  private static Step stepOf(transitions_t part, int state, int action) {
    return new Step(part.first_transition + state + 1, part.column[state], part.row[state], part.aoi[state],
        Math.floorDiv(action, part.sensor_count + 1), Math.floorMod(action, part.sensor_count + 1),
        part.time_margin[state], part.energy_margin_j[state], Double.NaN);
  }
}
