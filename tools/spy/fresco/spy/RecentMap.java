package fresco.spy;

import java.util.LinkedHashMap;
import java.util.Map;

/**
 * A map that drops the least recently used entry if it has too many, so that messages from a network can't
 * fill the memory.
 */
final class RecentMap<K, V> extends LinkedHashMap<K, V> {
  private static final long serialVersionUID = 1;
  private final int capacity;

  RecentMap(int capacity) {
    super(16, 0.75f, true);
    this.capacity = capacity;
  }

  @Override
  protected boolean removeEldestEntry(Map.Entry<K, V> eldest) {
    return size() > capacity;
  }
}
