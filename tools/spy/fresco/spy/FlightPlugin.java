package fresco.spy;

import fresco.flight_t;
import fresco.scenario_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** The window of flights as a viewer of lcm-spy, which finds this class by itself. */
public final class FlightPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == flight_t.LCM_FINGERPRINT || fingerprint == scenario_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return Windows.FLIGHT.action(channel);
  }
}
