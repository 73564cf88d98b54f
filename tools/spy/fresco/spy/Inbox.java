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
 * The messages of one window. LCM's thread decodes them and puts them into a queue of limited length, so it
 * never waits for a window that is busy painting. The event thread takes them out; only it touches what the
 * window shows.
 */
final class Inbox {
  private static final int CAPACITY = 4096; // about a second of a fast run's transitions
  private static LCM lcm;

  private record Subscription(String channel, LCMSubscriber subscriber) {}

  private final ArrayBlockingQueue<Runnable> waiting = new ArrayBlockingQueue<>(CAPACITY);
  private final List<Subscription> subscriptions = new ArrayList<>();

  /** Sets the URL of every window; the default is LCM_DEFAULT_URL. Call it before the first subscription. */
  static void connect(String url) throws IOException { lcm = new LCM(url); }

  private static LCM connection() { return lcm != null ? lcm : LCM.getSingleton(); }

  /** Passes the channel's messages to the handler, on the event thread. Ignores those that do not decode. */
  <M extends LCMEncodable> void subscribe(String channel, MessageType<M> type, Consumer<M> handler) {
    LCMSubscriber subscriber = (source, name, stream) -> {
      M message = type.decode(stream);
      if (message != null) {
        waiting.offer(() -> handler.accept(message)); // drops the message if the queue is full
      }
    };
    subscriptions.add(new Subscription(Pattern.quote(channel), subscriber));
    connection().subscribe(Pattern.quote(channel), subscriber);
  }

  /** Handles the messages that have arrived. Called on the event thread. */
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
