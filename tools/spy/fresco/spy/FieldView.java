package fresco.spy;

import java.awt.Dimension;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Point2D;
import java.awt.geom.Rectangle2D;

/** Maps positions in a field to the screen: the whole field, north up, with room for axes. Immutable. */
final class FieldView {
  private static final int LEFT = 62;
  private static final int RIGHT = 86; // the colour scale
  private static final int TOP = 16;
  private static final int BOTTOM = 52;

  private final Field field;
  private final double cellPixels;
  private final double left;
  private final double bottom;

  FieldView(Field field, Dimension size) {
    this.field = field;
    double width = Math.max(1, size.width - LEFT - RIGHT);
    double height = Math.max(1, size.height - TOP - BOTTOM);
    cellPixels = Math.min(width / field.columns(), height / field.rows());
    left = LEFT + (width - cellPixels * field.columns()) / 2;
    bottom = TOP + (height + cellPixels * field.rows()) / 2;
  }

  double cellPixels() { return cellPixels; }

  /** Returns the centre of a cell. Columns and rows may be fractions. */
  Point2D.Double place(double column, double row) {
    return new Point2D.Double(left + (column + 0.5) * cellPixels, bottom - (row + 0.5) * cellPixels);
  }

  Point2D.Double placeOf(Field.Sensor sensor) {
    return place(sensor.xM() / field.cellM(), sensor.yM() / field.cellM());
  }

  Rectangle2D.Double area() {
    double height = cellPixels * field.rows();
    return new Rectangle2D.Double(left, bottom - height, cellPixels * field.columns(), height);
  }

  Ellipse2D.Double coverage(Field.Sensor sensor) {
    double cells = Math.min(field.coverageRadiusM() / field.cellM(), 4.0 * (field.columns() + field.rows()));
    return circle(placeOf(sensor), cells * cellPixels);
  }

  static Ellipse2D.Double circle(Point2D centre, double radius) {
    return new Ellipse2D.Double(centre.getX() - radius, centre.getY() - radius, 2 * radius, 2 * radius);
  }
}
