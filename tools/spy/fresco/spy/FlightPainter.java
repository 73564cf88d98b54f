package fresco.spy;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Font;
import java.awt.Graphics2D;
import java.awt.Shape;
import java.awt.geom.Line2D;
import java.awt.geom.Point2D;

/** Paints what changes over a field: the age of the sensors' data, the UAV, its path and its collections. */
final class FlightPainter {
  private static final int MOST_WITH_NUMBERS = 60; // sensors
  private static final int MOST_FILLED = 25;

  private final Field field;
  private final FieldView view;
  private final Flight flight;
  private final int shown; // steps
  private final double scale; // the AoI of the brightest colour

  FlightPainter(Field field, FieldView view, Flight flight, int shown, double scale) {
    this.field = field;
    this.view = view;
    this.flight = flight;
    this.shown = shown;
    this.scale = scale;
  }

  private Step now() { return flight.steps.get(shown - 1); }

  private boolean isScheduled(int sensor) { return now().scheduled() == sensor + 1; }

  private boolean collects(int sensor) {
    return isScheduled(sensor) && field.covers(now().column(), now().row(), sensor);
  }

  void paintCoverage(Graphics2D g) {
    Graphics2D clipped = (Graphics2D) g.create();
    clipped.clip(view.area());
    boolean filled = field.sensors().size() <= MOST_FILLED;
    for (int n = 0; n < field.sensors().size(); ++n) {
      Color colour = collects(n) ? Palette.HIGHLIGHT : Palette.ACCENT;
      Shape circle = view.coverage(field.sensors().get(n));
      if (filled) {
        clipped.setColor(Palette.withAlpha(colour, collects(n) ? 40 : 20));
        clipped.fill(circle);
      }
      clipped.setColor(Palette.withAlpha(colour, collects(n) ? 255 : filled ? 120 : 60));
      clipped.setStroke(Palette.stroke(collects(n) ? 1.8 : 1));
      clipped.draw(circle);
    }
    clipped.dispose();
  }

  /** Paints the path so far. Older parts are paler. */
  void paintTrail(Graphics2D g, Point2D uav) {
    double width = Math.max(1.5, Math.min(4, view.cellPixels() / 7));
    g.setStroke(Palette.stroke(width));
    for (int i = 1; i <= shown; ++i) {
      Point2D from = placeOf(flight.steps.get(i - 1));
      Point2D to = i < shown ? placeOf(flight.steps.get(i)) : uav;
      int age = shown - i;
      g.setColor(Palette.between(Palette.ACCENT, Palette.SURFACE, Math.min(0.75, 0.02 * age)));
      g.draw(new Line2D.Double(from, to));
    }
  }

  /** Paints a dot wherever data were collected. */
  void paintCollections(Graphics2D g) {
    double radius = Math.max(1.5, Math.min(4.5, view.cellPixels() / 6));
    g.setStroke(Palette.stroke(1.2));
    for (Step step : flight.steps.subList(0, shown)) {
      int sensor = step.scheduled() - 1;
      boolean known = sensor >= 0 && sensor < field.sensors().size();
      if (known && field.covers(step.column(), step.row(), sensor)) {
        Shape dot = FieldView.circle(placeOf(step), radius);
        g.setColor(Palette.SURFACE);
        g.fill(dot);
        g.setColor(Palette.HIGHLIGHT);
        g.draw(dot);
      }
    }
  }

  void paintLink(Graphics2D g, Point2D uav) {
    int sensor = now().scheduled() - 1;
    if (sensor < 0 || sensor >= field.sensors().size()) {
      return;
    }
    g.setColor(collects(sensor) ? Palette.HIGHLIGHT : Palette.MUTED);
    float[] dashes = {6, 5};
    g.setStroke(collects(sensor)
            ? Palette.stroke(2.5)
            : new BasicStroke(1.5f, BasicStroke.CAP_BUTT, BasicStroke.JOIN_ROUND, 1, dashes, 0));
    g.draw(new Line2D.Double(uav, view.placeOf(field.sensors().get(sensor))));
  }

  void paintSensors(Graphics2D g) {
    boolean numbers = field.sensors().size() <= MOST_WITH_NUMBERS;
    for (int n = 0; n < field.sensors().size(); ++n) {
      Point2D place = view.placeOf(field.sensors().get(n));
      Color colour = Palette.viridis((now().aoi()[n] - 1) / Math.max(1, scale - 1));
      Shape disc = FieldView.circle(place, numbers ? 14 : 5);
      g.setColor(colour);
      g.fill(disc);
      g.setColor(collects(n) ? Palette.HIGHLIGHT : Palette.INK);
      g.setStroke(Palette.stroke(collects(n) ? 3 : 1.3));
      g.draw(disc);
      if (numbers) {
        g.setFont(g.getFont().deriveFont(Font.BOLD, 13f));
        g.setColor(Palette.inkOn(colour));
        Text.centred(g, Integer.toString(now().aoi()[n]), place.getX(), place.getY() + 5);
        paintName(g, n, place);
      }
    }
  }

  private void paintName(Graphics2D g, int sensor, Point2D place) {
    String name = "sensor " + (sensor + 1);
    g.setFont(g.getFont().deriveFont(Font.PLAIN, 12f));
    double width = g.getFontMetrics().stringWidth(name);
    double right = view.area().getMaxX() - width - 2;
    double x = Math.max(view.area().getMinX() + 2, Math.min(right, place.getX() - width / 2));
    boolean above = place.getY() + 34 > view.area().getMaxY();
    Text.haloed(g, name, x, place.getY() + (above ? -20 : 29), Palette.INK);
  }

  /** Paints a quadrotor, seen from above. */
  void paintUav(Graphics2D g, Point2D uav) {
    double arm = Math.max(5, Math.min(11, 0.45 * view.cellPixels()));
    g.setStroke(Palette.stroke(6));
    g.setColor(Color.WHITE);
    paintArms(g, uav, arm);
    g.setStroke(Palette.stroke(2.5));
    g.setColor(Palette.INK);
    paintArms(g, uav, arm);
    for (int corner = 0; corner < 4; ++corner) {
      Point2D rotor = corner(uav, arm, corner);
      g.setColor(Color.WHITE);
      g.fill(FieldView.circle(rotor, 0.55 * arm));
      g.setColor(Palette.INK);
      g.setStroke(Palette.stroke(1.8));
      g.draw(FieldView.circle(rotor, 0.55 * arm));
    }
  }

  private static Point2D corner(Point2D uav, double arm, int corner) {
    double x = corner % 2 == 0 ? -arm : arm;
    double y = corner / 2 == 0 ? -arm : arm;
    return new Point2D.Double(uav.getX() + x, uav.getY() + y);
  }

  private static void paintArms(Graphics2D g, Point2D uav, double arm) {
    g.draw(new Line2D.Double(corner(uav, arm, 0), corner(uav, arm, 3)));
    g.draw(new Line2D.Double(corner(uav, arm, 1), corner(uav, arm, 2)));
  }

  private Point2D placeOf(Step step) { return view.place(step.column(), step.row()); }
}
