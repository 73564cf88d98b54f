package fresco.spy;

import java.io.IOException;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.ArrayBlockingQueue;
import java.util.function.Consumer;
import java.util.regex.Pattern;
import lcm.lcm.LCM;
import lcm.lcm.LCMEncodable;
import lcm.lcm.LCMSubscriber;

/**
 * The messages of one window. LCM's thread decodes them and puts them into a queue that has an end, so that a
 * window that is busy painting never holds it up; the event thread takes them out and is the only one that
 * touches what the window shows.
 */
final class Inbox {
  private static final int CAPACITY = 4096; // about a second of a fast run's transitions
  private static LCM lcm;

  private record Subscription(String channel, LCMSubscriber subscriber) {}

  private final ArrayBlockingQueue<Runnable> waiting = new ArrayBlockingQueue<>(CAPACITY);
  private final List<Subscription> subscriptions = new ArrayList<>();

  /** The URL of every window; by default that of LCM_DEFAULT_URL. Before the first subscription. */
  static void connect(String url) throws IOException { lcm = new LCM(url); }

  private static LCM connection() { return lcm != null ? lcm : LCM.getSingleton(); }

  /** Hands the channel's messages to the handler, on the event thread. What does not decode is left out. */
  <M extends LCMEncodable> void subscribe(String channel, MessageType<M> type, Consumer<M> handler) {
    LCMSubscriber subscriber = (source, name, stream) -> {
      M message = type.decode(stream);
      if (message != null) {
        waiting.offer(() -> handler.accept(message)); // full: the newest is dropped, as a network does
      }
    };
    subscriptions.add(new Subscription(Pattern.quote(channel), subscriber));
    connection().subscribe(Pattern.quote(channel), subscriber);
  }

  /** Handles what has arrived. On the event thread. */
  void drain() {
    List<Runnable> arrived = new ArrayList<>();
    waiting.drainTo(arrived);
    arrived.forEach(Runnable::run);
  }

  void close() {
    subscriptions.forEach(one -> connection().unsubscribe(one.channel, one.subscriber));
    subscriptions.clear();
    waiting.clear();
  }
}
