package fresco.spy;

import fresco.actor_status_t;
import fresco.orders_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** The window of the actors as a viewer of lcm-spy, which finds this class by itself. */
public final class ActorPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == actor_status_t.LCM_FINGERPRINT || fingerprint == orders_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return Windows.ACTORS.action(channel);
  }
}
