package fresco.spy;

import fresco.learner_status_t;
import fresco.run_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** The window of the learner as a viewer of lcm-spy, which finds this class by itself. */
public final class LearnerPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == learner_status_t.LCM_FINGERPRINT || fingerprint == run_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return Windows.LEARNER.action(channel);
  }
}
