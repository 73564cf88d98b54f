package fresco.spy;

/**
 * Decides which complete episode is shown: dozens arrive each second, and each is shown for long enough to be
 * looked at. Used on the event thread.
 */
final class EpisodeChoice {
  /** Which episodes are shown. */
  enum Kind {
    NEWEST("newest episode"),
    EVALUATIONS("greedy evaluations");

    private final String label;

    Kind(String label) { this.label = label; }

    @Override
    public String toString() {
      return label;
    }
  }

  private static final double HOLD_S = 2;

  private Kind kind = Kind.NEWEST;
  private boolean paused;
  private Episode shown;
  private Episode newest; // not shown yet
  private Episode newestEvaluation;
  private double shownS = HOLD_S;

  void choose(Kind wanted) {
    kind = wanted;
    shownS = HOLD_S; // the next one may be shown at once
  }

  void setPaused(boolean stop) { paused = stop; }

  /** Forgets everything, because another run begins. */
  void clear() {
    newest = null;
    newestEvaluation = null;
    shownS = HOLD_S;
  }

  void offer(Episode episode, boolean evaluation) {
    newest = episode;
    newestEvaluation = evaluation ? episode : newestEvaluation;
  }

  /** Returns the episode that is to be shown from now on; null if none or still the same one. */
  Episode tick(double seconds) {
    shownS += seconds;
    Episode next = kind == Kind.NEWEST ? newest : newestEvaluation;
    if (paused || shownS < HOLD_S || next == null || next == shown) {
      return null;
    }
    shown = next;
    shownS = 0;
    return shown;
  }
}
