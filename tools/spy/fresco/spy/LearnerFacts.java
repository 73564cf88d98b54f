package fresco.spy;

import fresco.learner_status_t;
import java.awt.BorderLayout;
import java.awt.Color;
import javax.swing.JPanel;
import javax.swing.JProgressBar;

/** Shows the numbers of a learner's status. Used on the event thread. */
final class LearnerFacts {
  private static final int PARTS = 1000; // of the bar
  private static final double SILENT_S = 2;

  private final JProgressBar progress = new JProgressBar(0, PARTS);
  private final JPanel panel = new JPanel(new BorderLayout());
  private final Facts numbers = new Facts(4, "updates", "transitions", "replay memory", "actors",
      "best average AoI", "optimum", "gap", "loss", "epsilon", "learning rate", "staleness",
      "orders in flight", "received", "duplicate", "rejected", "asked again");
  private final Facts words = new Facts(1, "waits for", "warning");

  LearnerFacts() {
    progress.setStringPainted(true);
    panel.setBackground(Palette.SURFACE);
    panel.add(progress, BorderLayout.NORTH);
    panel.add(numbers, BorderLayout.CENTER);
    panel.add(words, BorderLayout.SOUTH);
  }

  JPanel component() { return panel; }

  void show(learner_status_t status, double silentS) {
    double share = (double) status.episodes / Math.max(1, status.total_episodes);
    progress.setValue((int) (PARTS * Math.min(Math.max(share, 0), 1)));
    progress.setString(String.format(
        "run %016x: %,d of %,d episodes", status.run_id, status.episodes, status.total_episodes));
    numbers.set("updates", String.format("%,d (%,.0f/s)", status.updates, status.updates_per_s));
    numbers.set("transitions", String.format("%,d (%,.0f/s)", status.transitions, status.transitions_per_s));
    numbers.set("replay memory", String.format("%,d transitions", status.replay_size));
    numbers.set("actors", Integer.toString(status.actors));
    showQuality(status);
    numbers.set("epsilon", Text.orDash("%.3f", status.epsilon));
    numbers.set("learning rate", Text.orDash("%.2e", status.learning_rate));
    numbers.set("staleness", Text.orDash("%,.0f updates", status.staleness_updates));
    numbers.set("orders in flight", Integer.toString(status.orders_in_flight));
    numbers.set("received", String.format("%,d messages", status.received));
    numbers.set("duplicate", String.format("%,d", status.duplicate));
    numbers.set("rejected", String.format("%,d", status.rejected), faultIf(status.rejected > 0));
    numbers.set("asked again", String.format("%,d orders", status.lost));
    showWords(status, silentS);
  }

  private void showQuality(learner_status_t status) {
    boolean bounded = status.optimum_proved == 0 && Double.isFinite(status.lower_bound_average_aoi);
    numbers.set("best average AoI", Text.orDash("%.3f slots", status.best_average_aoi));
    numbers.set("optimum",
        (bounded ? "not proved, at least " : "") + Text.orDash("%.3f slots", status.lower_bound_average_aoi));
    numbers.set("gap", bounded ? "not proved" : Text.orDash("%.2f %%", status.gap_percent));
    numbers.set("loss", Text.orDash("%.3g", status.loss));
  }

  private void showWords(learner_status_t status, double silentS) {
    if (silentS > SILENT_S) {
      words.set("waits for", String.format("nothing heard for %.0f s", silentS), Palette.FAULT);
    } else {
      words.set("waits for", status.waiting_for.isEmpty() ? "nobody" : status.waiting_for);
    }
    boolean warned = !status.warning.isEmpty();
    words.set("warning", warned ? status.warning : "none", faultIf(warned));
  }

  private static Color faultIf(boolean fault) { return fault ? Palette.FAULT : Palette.INK; }
}
