package fresco.spy;

import java.awt.Font;
import java.awt.Graphics2D;
import java.awt.Shape;
import java.awt.geom.Line2D;
import java.awt.geom.Point2D;
import java.awt.geom.Rectangle2D;

/** Paints the fixed parts of a field: the grid with its axes, obstacles, start and stop. */
final class FieldPainter {
  private static final int MOST_LINES = 25;
  private static final int MOST_TICKS = 6;

  private final Field field;
  private final FieldView view;

  FieldPainter(Field field, FieldView view) {
    this.field = field;
    this.view = view;
  }

  /** Returns the smallest of 1, 2, 5, 10, 20, .. that divides the length into at most so many parts. */
  static double niceStep(double length, int most) {
    double step = Math.pow(10, Math.floor(Math.log10(length / most)));
    for (double factor : new double[] {1, 2, 5}) {
      if (length / (step * factor) <= most) {
        return step * factor;
      }
    }
    return 10 * step;
  }

  void paintGrid(Graphics2D g) {
    Rectangle2D area = view.area();
    g.setColor(Palette.SURFACE);
    g.fill(area);
    paintObstacles(g);
    g.setColor(Palette.LINE);
    g.setStroke(Palette.stroke(0.6));
    int step = (int) Math.max(1, niceStep(Math.max(field.columns(), field.rows()), MOST_LINES));
    for (int column = step; column < field.columns(); column += step) {
      double x = view.place(column - 0.5, 0).x;
      g.draw(new Line2D.Double(x, area.getMinY(), x, area.getMaxY()));
    }
    for (int row = step; row < field.rows(); row += step) {
      double y = view.place(0, row - 0.5).y;
      g.draw(new Line2D.Double(area.getMinX(), y, area.getMaxX(), y));
    }
    g.setColor(Palette.MUTED);
    g.setStroke(Palette.stroke(1));
    g.draw(area);
  }

  private void paintObstacles(Graphics2D g) {
    Obstacles obstacles = field.obstacles();
    double pixels = view.cellPixels();
    for (int cell = 0; cell < obstacles.kinds().length; ++cell) {
      Point2D.Double place = view.place(cell % field.columns(), cell / field.columns());
      g.setColor(Palette.ofCell(obstacles.kindOf(cell)));
      g.fill(new Rectangle2D.Double(place.x - pixels / 2, place.y - pixels / 2, pixels, pixels));
    }
  }

  void paintAxes(Graphics2D g) {
    g.setColor(Palette.MUTED);
    g.setFont(g.getFont().deriveFont(Font.PLAIN, 12f));
    Rectangle2D area = view.area();
    double longestM = Math.max(field.columns(), field.rows()) * field.cellM();
    double stepM = niceStep(longestM, MOST_TICKS);
    for (double m = 0; m <= (field.columns() - 0.5) * field.cellM(); m += stepM) {
      double x = view.place(m / field.cellM(), 0).x;
      g.draw(new Line2D.Double(x, area.getMaxY(), x, area.getMaxY() + 4));
      Text.centred(g, Text.number(m), x, area.getMaxY() + 17);
    }
    for (double m = 0; m <= (field.rows() - 0.5) * field.cellM(); m += stepM) {
      double y = view.place(0, m / field.cellM()).y;
      g.draw(new Line2D.Double(area.getMinX() - 4, y, area.getMinX(), y));
      Text.right(g, Text.number(m), area.getMinX() - 8, y + 4);
    }
    Text.centred(g, "east, m", area.getCenterX(), area.getMaxY() + 38);
    Graphics2D turned = (Graphics2D) g.create();
    turned.rotate(-Math.PI / 2, area.getMinX() - 44, area.getCenterY());
    Text.centred(turned, "north, m", area.getMinX() - 44, area.getCenterY());
    turned.dispose();
  }

  void paintEnds(Graphics2D g) {
    if (field.start().equals(field.stop())) {
      paintEnd(g, "start and stop", field.start(), true);
    } else {
      paintEnd(g, "start", field.start(), false);
      paintEnd(g, "stop", field.stop(), true);
    }
  }

  private void paintEnd(Graphics2D g, String name, Field.Cell cell, boolean filled) {
    Point2D.Double place = view.place(cell.column(), cell.row());
    double half = Math.min(7, Math.max(3, 0.4 * view.cellPixels()));
    Shape square = new Rectangle2D.Double(place.x - half, place.y - half, 2 * half, 2 * half);
    g.setColor(filled ? Palette.INK : Palette.SURFACE);
    g.fill(square);
    g.setColor(Palette.INK);
    g.setStroke(Palette.stroke(1.8));
    g.draw(square);
    g.setFont(g.getFont().deriveFont(Font.BOLD, 13f));
    if (cell.column() < field.columns() / 2) {
      Text.haloed(g, name, place.x + 20, place.y + 4, Palette.INK);
    } else {
      double width = g.getFontMetrics().stringWidth(name);
      Text.haloed(g, name, place.x - 20 - width, place.y + 4, Palette.INK);
    }
  }
}
