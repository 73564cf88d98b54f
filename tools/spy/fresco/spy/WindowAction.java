package fresco.spy;

import java.awt.event.ActionEvent;
import javax.swing.AbstractAction;
import lcm.spy.ChannelData;

/** Opens a window for the run that a channel of lcm-spy's table belongs to. */
final class WindowAction extends AbstractAction {
  private static final long serialVersionUID = 1;
  private static final String DEFAULT_PREFIX = "FRESCO";
  private static final String[] SUFFIXES = {
      "_ORDERS", "_TRANSITIONS", "_ACTOR_STATUS", "_LEARNER_STATUS", "_SCENARIO", "_FLIGHT", "_RUN"};

  private final Windows window;
  private final String prefix;

  /** @param channel null where lcm-spy only asks for the name */
  WindowAction(Windows window, ChannelData channel) {
    super(window.title());
    this.window = window;
    this.prefix = channel == null ? DEFAULT_PREFIX : prefixOf(channel.name);
  }

  private static String prefixOf(String channel) {
    for (String suffix : SUFFIXES) {
      if (channel.endsWith(suffix)) {
        return channel.substring(0, channel.length() - suffix.length());
      }
    }
    return DEFAULT_PREFIX;
  }

  @Override
  public void actionPerformed(ActionEvent event) {
    window.open(prefix);
  }
}
