package fresco.spy;

import fresco.transitions_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/**
 * The window that fits a run's world as a viewer of lcm-spy, which finds this class by itself. A double click
 * takes the first viewer in the order of their names.
 */
public final class EpisodePlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == transitions_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return Windows.FITTING.action(channel);
  }
}
