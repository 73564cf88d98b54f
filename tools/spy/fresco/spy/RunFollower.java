package fresco.spy;

import java.util.function.LongSupplier;

/**
 * Decides which run a window shows if there are several on its channels: the first one, until it has been
 * silent for a while. Used on the event thread.
 */
final class RunFollower {
  private static final long SILENT_NS = 3_000_000_000L;

  /** A message is of the run that is shown, the first one of a run shown from now on, or of another run. */
  enum Hearing { SAME, NEW, OTHER }

  private final LongSupplier clockNs;
  private boolean heard;
  private long runId;
  private long lastNs;

  /** @param clockNs a clock that never jumps, nanoseconds */
  RunFollower(LongSupplier clockNs) { this.clockNs = clockNs; }

  long runId() { return runId; }

  Hearing hear(long run) {
    long now = clockNs.getAsLong();
    if (heard && run != runId && now - lastNs < SILENT_NS) {
      return Hearing.OTHER;
    }
    boolean same = heard && run == runId;
    heard = true;
    runId = run;
    lastNs = now;
    return same ? Hearing.SAME : Hearing.NEW;
  }

  /** Returns the seconds since the run's last message. */
  double silentS() { return heard ? (clockNs.getAsLong() - lastNs) * 1e-9 : 0; }
}
