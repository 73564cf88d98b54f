package fresco.spy;

import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;

/** The known part of a flight: an episode, or a flight of `fresco fly`. Used on the event thread. */
final class Flight {
  static final int FLYING = 0;
  static final int ARRIVED = 1;
  static final int OUT_OF_TIME = 2;
  static final int OUT_OF_ENERGY = 3;
  private static final String[] OUTCOMES = {"flying", "arrived", "out of time", "out of energy"};

  final long runId;
  final long number; // the order's index, or that of fly's flight
  final String source; // who flew it, for people
  final boolean live; // its slots arrive while it is flown
  final List<Step> steps = new ArrayList<>();
  int outcome = FLYING;
  String kind; // what kind of flight it is, for people

  Flight(long runId, long number, String kind, String source, boolean live) {
    this.runId = runId;
    this.number = number;
    this.kind = kind;
    this.source = source;
    this.live = live;
  }

  /** Returns an episode of the UAV's world as a flight. */
  static Flight of(Episode episode) {
    Flight flight = new Flight(episode.runId(), episode.order(), "episode", episode.actor(), false);
    for (int i = 0; i < episode.states().length; ++i) {
      flight.steps.add(Step.of(episode, i));
    }
    flight.outcome = flight.steps.get(episode.steps()).outcome();
    return flight;
  }

  int sensors() { return steps.isEmpty() ? 0 : steps.get(0).aoi().length; }

  String outcomeName() { return outcome >= 0 && outcome < OUTCOMES.length ? OUTCOMES[outcome] : "?"; }

  /** Returns the sum of the AoI of all sensors in the first `count` steps. */
  long totalAoi(int count) { return steps.stream().limit(count).mapToLong(Step::totalAoi).sum(); }

  /**
   * Returns the weighted mean AoI of the first `count` steps, slots. Without a field, all weights are equal.
   */
  double averageAoi(int count, Field field) {
    double[] theta = field == null ? new double[sensors()] : field.theta();
    if (field == null) {
      Arrays.fill(theta, 1.0 / theta.length);
    }
    double sum = 0;
    for (Step step : steps.subList(0, count)) {
      for (int n = 0; n < theta.length; ++n) {
        sum += theta[n] * step.aoi()[n];
      }
    }
    return sum / count;
  }

  /** Returns the largest AoI of scales and axes: that of the flight, rounded up. */
  int scale() {
    int oldest = steps.stream().mapToInt(Step::oldest).max().orElse(1);
    return Math.max(10, (oldest + 9) / 10 * 10);
  }
}
