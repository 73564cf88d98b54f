package fresco.spy;

import fresco.learner_status_t;
import info.monitorenter.gui.chart.ITrace2D;
import java.util.List;

/** Draws the curves of a run's learner. Used on the event thread. */
final class LearnerCharts {
  private static final String X_TITLE = "training episodes";
  private static final double POINTS_A_RUN = 2000; // of a curve; more would not be visible

  private final Curves loss = new Curves("Loss: mean squared temporal-difference error", X_TITLE, "loss");
  private final Curves score = new Curves("Score of greedy episodes", X_TITLE, "score");
  private final Curves success = new Curves("Greedy episodes that succeeded", X_TITLE, "share, %");
  private final Curves gap = new Curves("Gap of the best episode to the exact optimum", X_TITLE, "gap, %");
  private final Curves rates = new Curves("Rates", X_TITLE, "a second");
  private final ITrace2D lossTrace = loss.add("loss", Palette.ACCENT, 1.6);
  private final ITrace2D lastTrace = score.add("last evaluation", Palette.series(5), 1.2);
  private final ITrace2D bestTrace = score.add("best so far", Palette.series(0), 2.2);
  private final ITrace2D successTrace = success.add("last evaluation", Palette.series(2), 1.8);
  private final ITrace2D gapTrace = gap.add("gap", Palette.HIGHLIGHT, 1.8);
  private final ITrace2D transitionsTrace = rates.add("transitions", Palette.series(0), 1.6);
  private final ITrace2D updatesTrace = rates.add("updates", Palette.series(1), 1.6);
  private final Rows rows = new Rows();
  private ITrace2D boundTrace; // this and the optimum: null until they are heard of
  private ITrace2D optimumTrace;
  private boolean lessIsBetter;
  private double nextPoint;

  LearnerCharts() { layOut(); }

  Rows component() { return rows; }

  private List<Curves> all() { return List.of(loss, score, success, gap, rates); }

  private void layOut() {
    rows.show(List.of(
        List.of(loss, score), gapTrace.isEmpty() ? List.of(success, rates) : List.of(success, gap, rates)));
  }

  /** Shows what the score and the success of the run's world are called. */
  void name(WorldNames names) {
    lessIsBetter = names.lessIsBetter();
    String label = names.score().label();
    String better = lessIsBetter ? "less is better" : "more is better";
    score.setTitles(
        Text.capitalised(label) + " of greedy episodes (" + better + ")", names.score().labelAndUnit());
    String succeeded = Quantity.inWords(names.success());
    success.setTitles("Success: greedy episodes that " + succeeded, succeeded + ", %");
  }

  /** Begins the curves of a new run, or of one that was resumed from a checkpoint. */
  void begin(learner_status_t status) {
    nextPoint = status.episodes;
    all().forEach(Curves::clear);
    forgetOptimum();
    all().forEach(curves -> curves.setXRange(0, Math.min(Math.max(1, status.total_episodes), 1L << 40)));
    success.setYRange(0, 100);
    layOut();
  }

  private void forgetOptimum() {
    if (boundTrace != null) {
      score.remove(boundTrace);
    }
    if (optimumTrace != null) {
      score.remove(optimumTrace);
    }
    boundTrace = null;
    optimumTrace = null;
  }

  void add(learner_status_t status) {
    boolean justProved = status.optimum_proved != 0 && optimumTrace == null;
    if (status.episodes >= nextPoint || justProved) { // the proof may come after the last episode
      nextPoint = status.episodes + Math.max(1, status.total_episodes / POINTS_A_RUN);
      addPoints(status);
    }
  }

  private void addPoints(learner_status_t status) {
    add(lossTrace, status.updates > 0 ? status.loss : Double.NaN, status);
    add(lastTrace, status.score, status);
    add(bestTrace, status.best_score, status);
    add(successTrace, Double.isFinite(status.score) ? 100 * status.success : Double.NaN, status);
    addOptimum(status);
    boolean first = gapTrace.isEmpty();
    add(gapTrace, status.gap_percent, status);
    if (first && !gapTrace.isEmpty()) {
      layOut();
    }
    add(transitionsTrace, status.transitions_per_s, status);
    add(updatesTrace, status.updates_per_s, status);
  }

  private void addOptimum(learner_status_t status) {
    if (!isDrawable(status.score_bound)) {
      return;
    }
    if (status.optimum_proved == 0) {
      if (boundTrace == null) {
        boundTrace =
            score.add((lessIsBetter ? "lower" : "upper") + " bound of the optimum", Palette.series(3), 1.2);
      }
      add(boundTrace, status.score_bound, status);
    } else {
      if (optimumTrace == null) {
        optimumTrace = score.add("exact optimum", Palette.series(2), 1.8);
        optimumTrace.addPoint(0, status.score_bound); // the line covers the whole run
      }
      add(optimumTrace, status.score_bound, status);
    }
  }

  private static boolean isDrawable(double value) {
    return Math.abs(value) < 1e12; // false for NaN: there is no value yet
  }

  private static void add(ITrace2D trace, double value, learner_status_t status) {
    if (isDrawable(value)) {
      trace.addPoint(status.episodes, value);
    }
  }

  void fit() {
    List.of(loss, score, rates).forEach(Curves::fitY);
    gap.fitYToNewerHalf();
  }

  void close() { all().forEach(Curves::close); }
}
