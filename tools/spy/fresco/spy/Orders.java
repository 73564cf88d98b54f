package fresco.spy;

import fresco.order_t;
import fresco.orders_t;
import java.util.Map;

/** Remembers the latest orders, and describes their episodes. Used on the event thread. */
final class Orders {
  private static final int REMEMBERED = 1024;
  private static final byte EVALUATE = 1;

  private record Key(long runId, long index) {}

  private final Map<Key, order_t> orders = new RecentMap<>(REMEMBERED);

  void add(orders_t message) {
    for (order_t order : message.orders) {
      orders.put(new Key(message.run_id, order.index), order);
    }
  }

  boolean isEvaluation(long runId, long index) {
    order_t order = orders.get(new Key(runId, index));
    return order != null && order.kind == EVALUATE;
  }

  /** Returns for example "training, epsilon 0.120, beam of 16 from transition 9 on, network 56". */
  String describe(long runId, long index) {
    order_t order = orders.get(new Key(runId, index));
    if (order == null) {
      return "episode";
    }
    if (order.kind == EVALUATE) {
      return "greedy evaluation of network " + order.current_version;
    }
    String search = order.search_width == 0
        ? ""
        : String.format("beam of %d from transition %d on, ", order.search_width, order.search_from);
    return String.format("training, epsilon %.3f, %snetwork %d", order.epsilon, search, order.current_version);
  }
}
