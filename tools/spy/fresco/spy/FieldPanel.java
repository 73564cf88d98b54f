package fresco.spy;

import java.awt.Dimension;
import java.awt.Font;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.geom.Line2D;
import java.awt.geom.Point2D;
import java.awt.geom.Rectangle2D;
import javax.swing.JPanel;

/** Shows a flight over its field, seen from above. Used on the event thread. */
final class FieldPanel extends JPanel {
  private static final long serialVersionUID = 1;

  private transient Field field;
  private transient Flight flight;
  private double position;
  private String missing = "";

  FieldPanel() {
    setBackground(Palette.PAPER);
    setPreferredSize(new Dimension(740, 700));
  }

  /** Shows a flight over its field at a position (see Player). */
  void show(Field over, Flight flown, double at) {
    field = over;
    flight = flown;
    position = at;
    repaint();
  }

  /** Shows a text instead, which says what is missing. */
  void showMissing(String what) {
    field = null;
    missing = what;
    repaint();
  }

  @Override
  protected void paintComponent(Graphics graphics) {
    super.paintComponent(graphics);
    Graphics2D g = (Graphics2D) graphics.create();
    g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    g.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
    g.setRenderingHint(RenderingHints.KEY_STROKE_CONTROL, RenderingHints.VALUE_STROKE_PURE);
    if (field == null) {
      g.setColor(Palette.MUTED);
      g.setFont(g.getFont().deriveFont(Font.PLAIN, 15f));
      Text.centred(g, missing, getWidth() / 2.0, getHeight() / 2.0);
    } else {
      paintAll(g, new FieldView(field, getSize()));
    }
    g.dispose();
  }

  private void paintAll(Graphics2D g, FieldView view) {
    int shown = Math.min(flight.steps.size(), (int) position + 1);
    double scale = flight.scale();
    FieldPainter ground = new FieldPainter(field, view);
    FlightPainter above = new FlightPainter(field, view, flight, shown, scale);
    Point2D uav = placeOfUav(view);
    ground.paintGrid(g);
    ground.paintAxes(g);
    above.paintCoverage(g);
    above.paintTrail(g, uav);
    above.paintCollections(g);
    ground.paintEnds(g);
    above.paintLink(g, uav);
    above.paintSensors(g);
    above.paintUav(g, uav);
    paintScale(g, view.area(), scale);
  }

  private Point2D placeOfUav(FieldView view) {
    int index = Math.min((int) position, flight.steps.size() - 1);
    Step from = flight.steps.get(index);
    Step to = flight.steps.get(Math.min(index + 1, flight.steps.size() - 1));
    double way = position - index;
    return view.place(
        from.column() + way * (to.column() - from.column()), from.row() + way * (to.row() - from.row()));
  }

  private void paintScale(Graphics2D g, Rectangle2D area, double scale) {
    double left = area.getMaxX() + 22;
    double height = Math.min(260, 0.6 * area.getHeight());
    double top = area.getCenterY() - height / 2;
    for (int i = 0; i < height; ++i) {
      g.setColor(Palette.viridis(1 - i / height));
      g.fill(new Rectangle2D.Double(left, top + i, 14, 1.5));
    }
    g.setFont(g.getFont().deriveFont(Font.PLAIN, 12f));
    g.setColor(Palette.MUTED);
    g.setStroke(Palette.stroke(1));
    double step = FieldPainter.niceStep(scale, 5);
    for (double aoi = 0; aoi <= scale; aoi += step) {
      double age = Math.max(1, aoi);
      double y = top + height * (1 - (age - 1) / (scale - 1));
      g.draw(new Line2D.Double(left + 14, y, left + 18, y));
      g.drawString(Text.number(age), (float) left + 21, (float) y + 4);
    }
    g.drawString("AoI,", (float) left, (float) top - 24);
    g.drawString("slots", (float) left, (float) top - 9);
  }
}
