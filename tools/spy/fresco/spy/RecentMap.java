package fresco.spy;

import java.util.LinkedHashMap;
import java.util.Map;

/**
 * A map that forgets the entry used longest ago where it has too many: nothing from a network may fill
 * memory.
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
