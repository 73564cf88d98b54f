package fresco.spy;

import fresco.transitions_t;
import fresco.world_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** The window of episodes in any world as a viewer of lcm-spy, which finds this class by itself. */
public final class WorldPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == world_t.LCM_FINGERPRINT || fingerprint == transitions_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return Windows.EPISODE.action(channel);
  }
}
