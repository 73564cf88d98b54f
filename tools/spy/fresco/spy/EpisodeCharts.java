package fresco.spy;

import info.monitorenter.gui.chart.ITrace2D;
import java.util.ArrayList;
import java.util.List;
import java.util.function.IntToDoubleFunction;

/** Draws the fields of an episode's states and its rewards over its steps. Used on the event thread. */
final class EpisodeCharts {
  private static final int ALL_POINTS = 1000; // longer curves show the extremes of so many pieces
  private static final int MOST_NAMES_BELOW = 4; // of curves in a chart
  private static final double LARGEST = 1e12;
  private static final double WIDTH = 1.6;

  /** The curve of a field. */
  private record Curve(int field, ITrace2D trace) {}

  private final Rows rows = new Rows();
  private final List<Curves> charts = new ArrayList<>();
  private final List<Curve> curves = new ArrayList<>();
  private ITrace2D rewards;
  private WorldNames names;

  Rows component() { return rows; }

  void show(Episode episode) {
    if (episode.names() != names) {
      names = episode.names();
      prepare(new FieldGroups(names.state()));
    }
    charts.forEach(Curves::clear);
    for (Curve curve : curves) {
      draw(curve.trace(), episode.states().length, step -> episode.states()[step][curve.field()]);
    }
    draw(rewards, episode.steps(), step -> episode.rewards()[step]);
    for (Curves chart : charts) {
      chart.setXRange(0, episode.steps());
      chart.fitY();
    }
  }

  private void prepare(FieldGroups groups) {
    close();
    for (FieldGroups.Group group : groups.groups) {
      Curves chart = new Curves(group.heading(), "step", group.unit().isEmpty() ? "value" : group.unit());
      for (int i = 0; i < group.fields().size(); ++i) {
        int field = group.fields().get(i);
        String label = names.state().get(field).label();
        curves.add(new Curve(field, chart.add(label, Palette.series(i), Palette.seriesStroke(i, WIDTH))));
      }
      if (group.fields().size() > MOST_NAMES_BELOW) {
        chart.nameBeside();
      }
      charts.add(chart);
    }
    Curves last = new Curves("Rewards", "step", "reward");
    rewards = last.add("reward of the step", Palette.HIGHLIGHT, WIDTH);
    charts.add(last);
    rows.show(rowsOf(charts));
  }

  /**
   * Returns rows of one chart if there are few, otherwise of two; the last chart may have a row of its own.
   */
  private static List<List<Curves>> rowsOf(List<Curves> charts) {
    int columns = charts.size() <= 3 ? 1 : 2;
    List<List<Curves>> rows = new ArrayList<>();
    for (int i = 0; i < charts.size(); i += columns) {
      rows.add(charts.subList(i, Math.min(charts.size(), i + columns)));
    }
    return rows;
  }

  private static void draw(ITrace2D trace, int points, IntToDoubleFunction value) {
    if (points <= ALL_POINTS) {
      for (int i = 0; i < points; ++i) {
        add(trace, i, value);
      }
      return;
    }
    for (int piece = 0; piece < ALL_POINTS / 2; ++piece) {
      int from = (int) ((long) points * piece / (ALL_POINTS / 2));
      int to = (int) ((long) points * (piece + 1) / (ALL_POINTS / 2));
      drawExtremes(trace, from, to, value);
    }
  }

  private static void drawExtremes(ITrace2D trace, int from, int to, IntToDoubleFunction value) {
    int lowest = from;
    int highest = from;
    for (int i = from; i < to; ++i) {
      lowest = value.applyAsDouble(i) < value.applyAsDouble(lowest) ? i : lowest;
      highest = value.applyAsDouble(i) > value.applyAsDouble(highest) ? i : highest;
    }
    add(trace, Math.min(lowest, highest), value);
    add(trace, Math.max(lowest, highest), value);
  }

  private static void add(ITrace2D trace, int step, IntToDoubleFunction value) {
    double y = value.applyAsDouble(step);
    if (Math.abs(y) < LARGEST) { // false for NaN
      trace.addPoint(step, y);
    }
  }

  void close() {
    charts.forEach(Curves::close);
    charts.clear();
    curves.clear();
  }
}
