package fresco.spy;

/**
 * Decides which flight is shown, and how much of it. Dozens of episodes arrive each second. One is shown from
 * start to end at a pace that people can follow, then the newest complete one. A live flight is shown while it
 * arrives, and has precedence over episodes. Used on the event thread.
 */
final class Player {
  /** Which flights are shown. */
  enum Choice {
    NEWEST("newest flight"),
    EVALUATIONS("greedy evaluations"),
    FLY("fresco fly");

    private final String label;

    Choice(String label) { this.label = label; }

    @Override
    public String toString() {
      return label;
    }
  }

  private static final double HOLD_S = 1.5; // at the end of an episode
  private static final double LIVE_S = 5; // after so much silence, a live flight gives way to episodes
  private static final double CATCH_UP_S = 0.3;

  private Choice choice = Choice.NEWEST;
  private double slotsPerS = 8;
  private boolean paused;
  private Flight flight;
  private Flight newest; // complete, not shown yet
  private Flight newestEvaluation;
  private double position; // index of the step, with a fraction on the way to the next
  private double heldS;
  private double silentS = LIVE_S; // of a live flight

  Flight flight() { return flight; }

  double position() { return position; }

  /** Returns the number of steps that have begun, at least one. */
  int shownSteps() { return Math.min(flight.steps.size(), (int) position + 1); }

  void choose(Choice wanted) {
    choice = wanted;
    heldS = HOLD_S; // the next one may be shown at once
  }

  void setSlotsPerS(double slots) { slotsPerS = slots; }

  void setPaused(boolean stop) { paused = stop; }

  /** Offers a complete episode, to be shown next. */
  void offer(Flight episode, boolean evaluation) {
    newest = episode;
    newestEvaluation = evaluation ? episode : newestEvaluation;
  }

  /** Shows a live flight, which has got a further slot. */
  void follow(Flight live) {
    if (choice == Choice.EVALUATIONS || paused) {
      return;
    }
    silentS = 0;
    if (flight != live) {
      show(live);
    }
  }

  void tick(double seconds) {
    silentS += seconds;
    if (paused) {
      return;
    }
    if (flight != null) {
      advance(seconds);
    }
    if (isOver()) {
      showNext();
    }
  }

  private void advance(double seconds) {
    double end = flight.steps.size() - 1;
    double pace = flight.live ? Math.max(slotsPerS, (end - position) / CATCH_UP_S) : slotsPerS;
    position = Math.min(end, position + pace * seconds);
    heldS = position < end ? 0 : heldS + seconds;
  }

  private boolean isOver() { return flight == null || (flight.live ? silentS >= LIVE_S : heldS >= HOLD_S); }

  private void showNext() {
    Flight next = choice == Choice.NEWEST ? newest : choice == Choice.EVALUATIONS ? newestEvaluation : null;
    if (next != null) {
      show(next);
    }
  }

  private void show(Flight next) {
    flight = next;
    position = 0;
    heldS = 0;
    newest = next == newest ? null : newest;
    newestEvaluation = next == newestEvaluation ? null : newestEvaluation;
  }
}
