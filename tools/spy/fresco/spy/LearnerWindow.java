package fresco.spy;

import fresco.learner_status_t;
import java.awt.BorderLayout;
import java.awt.Dimension;
import javax.swing.JPanel;

/**
 * Shows a run's learner: loss, score, success, rates, and the gap to the optimum in a world that has a search
 * for it. Used on the event thread.
 */
final class LearnerWindow extends Window {
  private static final int PERIOD_MS = 200;

  private final Worlds worlds = new Worlds();
  private final LearnerCharts charts = new LearnerCharts();
  private final LearnerFacts facts = new LearnerFacts();
  private final RunFollower run = new RunFollower(System::nanoTime);
  private final String prefix;
  private learner_status_t last;
  private WorldNames names; // those that are shown; null: none yet

  LearnerWindow(String prefix) {
    super(PERIOD_MS);
    this.prefix = prefix;
    inbox().subscribe(prefix + "_WORLD", MessageTypes.WORLD, worlds::add);
    inbox().subscribe(prefix + "_LEARNER_STATUS", MessageTypes.LEARNER_STATUS, this::add);
    open("Fresco learner: waiting on " + prefix + "_LEARNER_STATUS", content(), new Dimension(1240, 800));
  }

  private JPanel content() {
    JPanel content = new JPanel(new BorderLayout(8, 8));
    content.add(facts.component(), BorderLayout.NORTH);
    content.add(charts.component(), BorderLayout.CENTER);
    return content;
  }

  private void add(learner_status_t status) {
    RunFollower.Hearing hearing = run.hear(status.run_id);
    if (hearing == RunFollower.Hearing.OTHER) {
      return;
    }
    if (hearing == RunFollower.Hearing.NEW || (last != null && status.episodes < last.episodes)) {
      charts.begin(status); // a new run, or one that was resumed from a checkpoint
    }
    last = status;
    if (name(worlds.of(status.run_id))) { // a score without a name would be drawn under a wrong one
      charts.add(status);
    }
  }

  /** Returns whether the names of the run that is shown are known. */
  private boolean name(WorldNames heard) {
    if (heard != null && heard != names) {
      names = heard;
      charts.name(names);
    }
    return heard != null;
  }

  @Override
  void update(double seconds) {
    if (last != null) {
      setTitle(String.format("Fresco learner: run %016x on %s", last.run_id, prefix));
      facts.show(last, worlds.of(last.run_id), run.silentS());
      charts.fit();
    }
  }

  @Override
  void closed() {
    charts.close();
  }
}
