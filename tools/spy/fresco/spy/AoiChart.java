package fresco.spy;

import info.monitorenter.gui.chart.ITrace2D;
import java.util.ArrayList;
import java.util.List;

/** Shows the age of each sensor's data up to the slot that is shown. Used on the event thread. */
final class AoiChart {
  private final Curves curves = new Curves("Age of information", "slot", "AoI, slots");
  private final List<ITrace2D> traces = new ArrayList<>();
  private Flight flight;
  private int shown;

  Curves component() { return curves; }

  void show(Flight flown, int steps, int slots) {
    if (flown != flight || steps < shown) {
      flight = flown;
      shown = 0;
      prepare(flown.sensors());
      curves.setXRange(0, slots);
    }
    for (; shown < steps; ++shown) {
      add(flight.steps.get(shown));
    }
    curves.setYRange(0, flown.scale());
  }

  private static boolean oneEach(int sensors) { return sensors <= Palette.SERIES_COLOURS; }

  private void prepare(int sensors) {
    curves.clear();
    int wanted = oneEach(sensors) ? sensors : 2;
    if (wanted == traces.size() && oneEach(sensors) == traces.get(0).getName().startsWith("sensor")) {
      return;
    }
    traces.forEach(curves::remove);
    traces.clear();
    for (int n = 0; n < wanted; ++n) {
      String name = oneEach(sensors) ? "sensor " + (n + 1) : n == 0 ? "mean of the sensors" : "oldest sensor";
      traces.add(curves.add(name, Palette.series(n), 1.8));
    }
  }

  private void add(Step step) {
    if (oneEach(step.aoi().length)) {
      for (int n = 0; n < traces.size(); ++n) {
        traces.get(n).addPoint(step.slot(), step.aoi()[n]);
      }
    } else {
      traces.get(0).addPoint(step.slot(), (double) step.totalAoi() / step.aoi().length);
      traces.get(1).addPoint(step.slot(), step.oldest());
    }
  }
}
