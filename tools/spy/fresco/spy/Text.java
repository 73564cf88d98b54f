package fresco.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.Shape;
import java.awt.geom.AffineTransform;
import java.util.Locale;

/** Draws texts, and turns numbers into texts. */
final class Text {
  private Text() {}

  static void centred(Graphics2D g, String text, double x, double baseline) {
    g.drawString(text, (float) (x - g.getFontMetrics().stringWidth(text) / 2.0), (float) baseline);
  }

  static void right(Graphics2D g, String text, double x, double baseline) {
    g.drawString(text, (float) (x - g.getFontMetrics().stringWidth(text)), (float) baseline);
  }

  /** Draws with a white edge, which is legible on anything. */
  static void haloed(Graphics2D g, String text, double x, double baseline, Color colour) {
    Shape outline = g.getFont().createGlyphVector(g.getFontRenderContext(), text).getOutline();
    Shape placed = AffineTransform.getTranslateInstance(x, baseline).createTransformedShape(outline);
    g.setColor(Palette.withAlpha(Color.WHITE, 220));
    g.setStroke(Palette.stroke(3.5));
    g.draw(placed);
    g.setColor(colour);
    g.fill(placed);
  }

  /** Returns a whole number without a fraction, any other with four digits. */
  static String number(double value) {
    return value == Math.rint(value) ? String.format(Locale.ROOT, "%.0f", value)
                                     : String.format(Locale.ROOT, "%.4g", value);
  }

  /** Returns a score or a sum of rewards; "-" if it is not finite. */
  static String amount(double value) {
    return orDash(value != 0 && Math.abs(value) < 0.1 ? "%.3g" : "%,.3f", value);
  }

  static String capitalised(String text) {
    return text.isEmpty() ? text : text.substring(0, 1).toUpperCase(Locale.ROOT) + text.substring(1);
  }

  /** Returns "-" if the value is not finite. */
  static String orDash(String format, double value) {
    return Double.isFinite(value) ? String.format(Locale.ROOT, format, value) : "-";
  }
}
