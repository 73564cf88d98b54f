package fresco.spy;

import fresco.learner_status_t;
import info.monitorenter.gui.chart.ITrace2D;
import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.GridLayout;
import java.util.List;
import javax.swing.JPanel;

/** Shows a run's learner: loss, AoI, gap to the optimum and rates. Used on the event thread. */
final class LearnerWindow extends Window {
  private static final int PERIOD_MS = 200;
  private static final double POINTS_A_RUN = 2000; // of a curve; more would not be visible

  private final Curves loss =
      new Curves("Loss: mean squared temporal-difference error", "training episodes", "loss");
  private final Curves aoi =
      new Curves("Average AoI of greedy flights", "training episodes", "average AoI, slots");
  private final Curves gap = new Curves(
      "Gap of the best flight to the exact optimum, once that is proved", "training episodes", "gap, %");
  private final Curves rates = new Curves("Rates", "training episodes", "a second");
  private final ITrace2D lossTrace = loss.add("loss", Palette.ACCENT, 1.6);
  private final ITrace2D lastTrace = aoi.add("last evaluation", Palette.series(5), 1.2);
  private final ITrace2D bestTrace = aoi.add("best so far", Palette.series(0), 2.2);
  private final ITrace2D boundTrace = aoi.add("lower bound of the optimum", Palette.series(3), 1.2);
  private final ITrace2D optimumTrace = aoi.add("exact optimum", Palette.series(2), 1.8);
  private final ITrace2D gapTrace = gap.add("gap", Palette.HIGHLIGHT, 1.8);
  private final ITrace2D transitionsTrace = rates.add("transitions", Palette.series(0), 1.6);
  private final ITrace2D updatesTrace = rates.add("updates", Palette.series(1), 1.6);
  private final LearnerFacts facts = new LearnerFacts();
  private final RunFollower run = new RunFollower(System::nanoTime);
  private final String prefix;
  private learner_status_t last;
  private double nextPoint;

  LearnerWindow(String prefix) {
    super(PERIOD_MS);
    this.prefix = prefix;
    inbox().subscribe(prefix + "_LEARNER_STATUS", MessageTypes.LEARNER_STATUS, this::add);
    open("Fresco learner: waiting on " + prefix + "_LEARNER_STATUS", content(), new Dimension(1240, 800));
  }

  private JPanel content() {
    JPanel charts = new JPanel(new GridLayout(2, 2, 8, 8));
    charts.setOpaque(false);
    all().forEach(charts::add);
    JPanel content = new JPanel(new BorderLayout(8, 8));
    content.add(facts.component(), BorderLayout.NORTH);
    content.add(charts, BorderLayout.CENTER);
    return content;
  }

  private List<Curves> all() { return List.of(loss, aoi, gap, rates); }

  private void add(learner_status_t status) {
    RunFollower.Hearing hearing = run.hear(status.run_id);
    if (hearing == RunFollower.Hearing.OTHER) {
      return;
    }
    if (hearing == RunFollower.Hearing.NEW || (last != null && status.episodes < last.episodes)) {
      begin(status); // a new run, or one that was resumed from a checkpoint
    }
    boolean justProved = last != null && last.optimum_proved == 0 && status.optimum_proved != 0;
    last = status;
    if (status.episodes >= nextPoint || justProved) { // the proof may come after the last episode
      nextPoint = status.episodes + Math.max(1, status.total_episodes / POINTS_A_RUN);
      addPoints(status);
    }
  }

  private void begin(learner_status_t status) {
    nextPoint = status.episodes;
    all().forEach(Curves::clear);
    all().forEach(curves -> curves.setXRange(0, Math.min(Math.max(1, status.total_episodes), 1L << 40)));
  }

  private void addPoints(learner_status_t status) {
    add(lossTrace, status.updates > 0 ? status.loss : Double.NaN, status);
    add(lastTrace, status.average_aoi, status);
    add(bestTrace, status.best_average_aoi, status);
    boolean proved = status.optimum_proved != 0;
    if (proved && optimumTrace.isEmpty() && Double.isFinite(status.lower_bound_average_aoi)) {
      optimumTrace.addPoint(0, status.lower_bound_average_aoi); // the line covers the whole run
    }
    add(proved ? optimumTrace : boundTrace, status.lower_bound_average_aoi, status);
    add(gapTrace, status.gap_percent, status);
    add(transitionsTrace, status.transitions_per_s, status);
    add(updatesTrace, status.updates_per_s, status);
  }

  private static void add(ITrace2D trace, double value, learner_status_t status) {
    if (Math.abs(value) < 1e12) { // false for NaN: there is no value yet
      trace.addPoint(status.episodes, value);
    }
  }

  @Override
  void update(double seconds) {
    if (last != null) {
      setTitle(String.format("Fresco learner: run %016x on %s", last.run_id, prefix));
      facts.show(last, run.silentS());
      List.of(loss, aoi, rates).forEach(Curves::fitY);
      gap.fitYToNewerHalf();
    }
  }

  @Override
  void closed() {
    all().forEach(Curves::close);
  }
}
