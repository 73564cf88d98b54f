package fresco.spy;

import java.awt.event.ActionEvent;
import java.util.function.Consumer;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.SwingUtilities;
import lcm.spy.ChannelData;

/** Fresco's windows, by the names that `fresco spy --open` takes. */
enum Windows {
  FLIGHT("Fresco: flight over the field", FlightWindow::new),
  LEARNER("Fresco: learner's curves", LearnerWindow::new),
  ACTORS("Fresco: actors", ActorWindow::new),
  EPISODE("Fresco: states and rewards of an episode", EpisodeWindow::new),
  /** Flights in the UAV's world, episodes in any other, once the world is known. */
  FITTING("Fresco: episodes as they fit the world", FittingWindow::new);

  private static final String DEFAULT_PREFIX = "FRESCO";
  private static final String[] SUFFIXES = {"_ORDERS", "_TRANSITIONS", "_ACTOR_STATUS", "_LEARNER_STATUS",
      "_SCENARIO", "_FLIGHT", "_RUN", "_WORLD"};

  private final String title;
  private final Consumer<String> opener;

  Windows(String title, Consumer<String> opener) {
    this.title = title;
    this.opener = opener;
  }

  /** Opens a window of this kind for the channels of this prefix. Any thread may call it. */
  void open(String prefix) { SwingUtilities.invokeLater(() -> opener.accept(prefix)); }

  /**
   * Opens a window of this kind for the run that a channel of lcm-spy's table belongs to.
   *
   * @param channel null if lcm-spy only asks for the action's name
   */
  Action action(ChannelData channel) {
    String prefix = channel == null ? DEFAULT_PREFIX : prefixOf(channel.name);
    return new AbstractAction(title) {
      private static final long serialVersionUID = 1;

      @Override
      public void actionPerformed(ActionEvent event) {
        open(prefix);
      }
    };
  }

  private static String prefixOf(String channel) {
    for (String suffix : SUFFIXES) {
      if (channel.endsWith(suffix)) {
        return channel.substring(0, channel.length() - suffix.length());
      }
    }
    return DEFAULT_PREFIX;
  }
}
