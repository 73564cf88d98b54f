package fresco.spy;

import java.util.function.LongSupplier;

/**
 * Which run a window shows where there may be another on the same channels: the first heard of, until it has
 * been silent for a while. On the event thread.
 */
final class RunFollower {
  private static final long SILENT_NS = 3_000_000_000L;

  /** Whether a message is of the run that is shown, and whether it is the first of it. */
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

  /** Seconds since the run was heard of. */
  double silentS() { return heard ? (clockNs.getAsLong() - lastNs) * 1e-9 : 0; }
}
