package fresco.spy;

import fresco.world_t;
import java.util.Arrays;
import java.util.List;
import java.util.Map;

/** Joins world_t messages to the names of the latest runs. Used on the event thread. */
final class Worlds {
  private static final int REMEMBERED_RUNS = 16;
  private static final int MAXIMUM_STATE_SIZE = 10_000;
  private static final int MAXIMUM_ACTIONS = 4_000;
  private static final int MAXIMUM_FIGURES = 100;
  static final int MAXIMUM_STEPS = 100_000;

  /** What has been heard of a run. */
  private static final class Parts {
    final world_t first;
    final String[] lines;
    int missing;
    WorldNames names;

    Parts(world_t first) {
      this.first = first;
      lines = new String[total(first)];
      missing = lines.length;
    }

    boolean isOfOneWorldWith(world_t message) {
      return message.config_hash == first.config_hash && message.world.equals(first.world)
          && message.success.equals(first.success) && message.state_size == first.state_size
          && message.action_count == first.action_count && message.figure_count == first.figure_count
          && message.less_is_better == first.less_is_better
          && message.longest_episode == first.longest_episode;
    }

    void take(world_t message, List<String> entries) {
      boolean changed = false;
      for (int i = 0; i < entries.size(); ++i) {
        int index = message.first_entry + i;
        missing -= lines[index] == null ? 1 : 0;
        changed |= !entries.get(i).equals(lines[index]);
        lines[index] = entries.get(i);
      }
      if (changed && missing == 0) {
        names = namesOf();
      }
    }

    private WorldNames namesOf() {
      int actions = first.state_size;
      int figures = actions + first.action_count;
      return new WorldNames(first.world, quantities(0, actions),
          List.of(Arrays.copyOfRange(lines, actions, figures)), quantities(figures, lines.length),
          first.less_is_better != 0, first.success, first.longest_episode);
    }

    private List<Quantity> quantities(int from, int to) {
      return Arrays.stream(lines, from, to).map(Quantity::of).toList();
    }
  }

  private final Map<Long, Parts> runs = new RecentMap<>(REMEMBERED_RUNS);

  /** Returns the names of the run's world; null if some part of them is not known yet. */
  WorldNames of(long runId) {
    Parts parts = runs.get(runId);
    return parts == null ? null : parts.names;
  }

  void add(world_t message) {
    if (!isSound(message)) {
      return;
    }
    List<String> entries = message.entries.lines().toList();
    if (entries.size() != message.entry_count) {
      return;
    }
    Parts parts = runs.get(message.run_id);
    if (parts == null || !parts.isOfOneWorldWith(message)) {
      parts = new Parts(message);
      runs.put(message.run_id, parts);
    }
    parts.take(message, entries);
  }

  private static boolean isSound(world_t message) {
    return isWithin(message.state_size, 1, MAXIMUM_STATE_SIZE)
        && isWithin(message.action_count, 1, MAXIMUM_ACTIONS)
        && isWithin(message.figure_count, 1, MAXIMUM_FIGURES)
        && isWithin(message.longest_episode, 1, MAXIMUM_STEPS)
        && isWithin(message.entry_count, 1, total(message))
        && isWithin(message.first_entry, 0, total(message) - message.entry_count);
  }

  private static int total(world_t message) {
    return message.state_size + message.action_count + message.figure_count;
  }

  private static boolean isWithin(int value, int low, int high) { return value >= low && value <= high; }
}
