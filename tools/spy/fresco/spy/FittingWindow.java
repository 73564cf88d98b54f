package fresco.spy;

import fresco.scenario_t;
import fresco.world_t;
import javax.swing.Timer;

/**
 * Opens the window that shows episodes best, once it is heard which world there is: flights over the field in
 * the UAV's world, charts in any other. Used on the event thread.
 */
final class FittingWindow {
  private static final int PERIOD_MS = 100;

  private final Inbox inbox = new Inbox();
  private final Timer timer = new Timer(PERIOD_MS, event -> inbox.drain());
  private final Worlds worlds = new Worlds();
  private final String prefix;
  private boolean opened;

  FittingWindow(String prefix) {
    this.prefix = prefix;
    inbox.subscribe(prefix + "_WORLD", MessageTypes.WORLD, this::add);
    inbox.subscribe(prefix + "_SCENARIO", MessageTypes.SCENARIO, this::add);
    timer.start();
  }

  private void add(world_t message) {
    worlds.add(message);
    WorldNames names = worlds.of(message.run_id);
    if (names != null) {
      open(names.isUav() ? Windows.FLIGHT : Windows.EPISODE);
    }
  }

  private void add(scenario_t message) { open(Windows.FLIGHT); } // `fresco fly` sends it, too

  private void open(Windows window) {
    if (!opened) {
      opened = true;
      timer.stop();
      inbox.close();
      window.open(prefix);
    }
  }
}
