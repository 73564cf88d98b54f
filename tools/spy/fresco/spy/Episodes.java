package fresco.spy;

import fresco.transitions_t;
import java.util.Iterator;
import java.util.Map;

/** Joins transitions_t messages, in any order, to complete episodes. Used on the event thread. */
final class Episodes {
  private static final int OPEN_EPISODES = 256;
  private static final int REMEMBERED_EPISODES = 1024;
  private static final long MOST_FIELDS = 1 << 24; // of all open episodes, 64 MiB
  private static final int MOST_ENDINGS = 2;

  private record Key(long runId, long order) {}

  private final Map<Key, EpisodeParts> open = new RecentMap<>(OPEN_EPISODES);
  private final Map<Key, Boolean> done = new RecentMap<>(REMEMBERED_EPISODES);

  /**
   * Returns the episode if the message completes one, otherwise null.
   *
   * @param names of the run's world; null if they are not known yet
   */
  Episode add(transitions_t message, WorldNames names) {
    Key key = new Key(message.run_id, message.order_index);
    if (names == null || !isSound(message, names) || done.containsKey(key)) {
      return null;
    }
    EpisodeParts parts = open.get(key);
    if (parts == null || !parts.fits(message, names)) {
      parts = new EpisodeParts(names, message.seed);
      open.put(key, parts);
    }
    parts.take(message);
    if (!parts.isWhole()) {
      makeRoom();
      return null;
    }
    open.remove(key);
    done.put(key, true);
    return parts.episode(message);
  }

  /** Forgets the open episodes that have been silent for longest if all of them take too much memory. */
  private void makeRoom() {
    long fields = open.values().stream().mapToLong(EpisodeParts::cost).sum();
    for (Iterator<EpisodeParts> parts = open.values().iterator(); fields > MOST_FIELDS;) {
      fields -= parts.next().cost();
      parts.remove();
    }
  }

  private static boolean isSound(transitions_t message, WorldNames names) {
    boolean sound = message.transition_count >= 1 && message.state_count == message.transition_count + 1
        && message.field_count >= 1 && message.first_field >= 0
        && message.first_field <= names.state().size() - message.field_count && message.first_transition >= 0
        && message.first_transition <= names.longestEpisode() - message.transition_count
        && message.ending >= 0 && message.ending <= MOST_ENDINGS;
    for (int i = 0; sound && i < message.transition_count; ++i) {
      sound = message.action[i] >= 0 && message.action[i] < names.actions().size();
    }
    return sound;
  }
}
