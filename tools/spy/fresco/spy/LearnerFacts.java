package fresco.spy;

import fresco.learner_status_t;
import java.awt.BorderLayout;
import java.awt.Color;
import java.util.ArrayList;
import java.util.List;
import javax.swing.JPanel;
import javax.swing.JProgressBar;

/** Shows the numbers of a learner's status. Used on the event thread. */
final class LearnerFacts {
  private static final int PARTS = 1000; // of the bar
  private static final double SILENT_S = 2;

  private static final Quantity NAMELESS = new Quantity("score", "");

  private final JProgressBar progress = new JProgressBar(0, PARTS);
  private final JPanel panel = new JPanel(new BorderLayout());
  private final Facts words = new Facts(1, "waits for", "warning");
  private List<String> shownNames = List.of();
  private Facts numbers;

  LearnerFacts() {
    progress.setStringPainted(true);
    panel.setBackground(Palette.SURFACE);
    panel.add(progress, BorderLayout.NORTH);
    panel.add(words, BorderLayout.SOUTH);
  }

  JPanel component() { return panel; }

  /** @param world null if it is not known yet */
  void show(learner_status_t status, WorldNames world, double silentS) {
    Quantity score = world == null ? NAMELESS : world.score();
    String success = world == null ? "succeeded" : Quantity.inWords(world.success());
    boolean bounded = Double.isFinite(status.score_bound);
    layOut(namesOf(score, success, bounded));
    showProgress(status, world);
    numbers.set("updates", String.format("%,d (%,.0f/s)", status.updates, status.updates_per_s));
    numbers.set("transitions", String.format("%,d (%,.0f/s)", status.transitions, status.transitions_per_s));
    numbers.set("replay memory", String.format("%,d transitions", status.replay_size));
    numbers.set("actors", Integer.toString(status.actors));
    numbers.set("last " + score.label(), score.text(status.score));
    numbers.set("best " + score.label(), score.text(status.best_score));
    numbers.set(
        success, Text.orDash("%.0f %%", Double.isFinite(status.score) ? 100 * status.success : Double.NaN));
    numbers.set("loss", Text.orDash("%.3g", status.loss));
    if (bounded) {
      showOptimum(status, score, world != null && world.lessIsBetter());
    }
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

  private static List<String> namesOf(Quantity score, String success, boolean bounded) {
    List<String> names = new ArrayList<>(List.of("updates", "transitions", "replay memory", "actors",
        "last " + score.label(), "best " + score.label(), success, "loss"));
    if (bounded) {
      names.addAll(List.of("optimum", "gap"));
    }
    names.addAll(List.of("epsilon", "learning rate", "staleness", "orders in flight", "received", "duplicate",
        "rejected", "asked again"));
    return names;
  }

  private void layOut(List<String> names) {
    if (names.equals(shownNames)) {
      return;
    }
    if (numbers != null) {
      panel.remove(numbers);
    }
    shownNames = names;
    numbers = new Facts(4, names.toArray(String[] ::new));
    panel.add(numbers, BorderLayout.CENTER);
    panel.revalidate();
  }

  private void showProgress(learner_status_t status, WorldNames world) {
    double share = (double) status.episodes / Math.max(1, status.total_episodes);
    progress.setValue((int) (PARTS * Math.min(Math.max(share, 0), 1)));
    progress.setString(String.format("run %016x%s: %,d of %,d episodes", status.run_id,
        world == null ? "" : " in the world " + world.world(), status.episodes, status.total_episodes));
  }

  private void showOptimum(learner_status_t status, Quantity score, boolean lessIsBetter) {
    boolean proved = status.optimum_proved != 0;
    String notProved = lessIsBetter ? "not proved, at least " : "not proved, at most ";
    numbers.set("optimum", (proved ? "" : notProved) + score.text(status.score_bound));
    numbers.set("gap", proved ? Text.orDash("%.2f %%", status.gap_percent) : "not proved");
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
