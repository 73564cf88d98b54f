package fresco.spy;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Stroke;

/** The colours of all windows. They are those of the report page. */
final class Palette {
  static final Color PAPER = new Color(0xf6f7f8);
  static final Color SURFACE = Color.WHITE;
  static final Color INK = new Color(0x1c2329);
  static final Color MUTED = new Color(0x56616c);
  static final Color LINE = new Color(0xd5dbe1);
  static final Color ACCENT = new Color(0x0f62b3);
  static final Color HIGHLIGHT = new Color(0xb84700);
  static final Color FAULT = new Color(0xa61b1b);

  private static final int[] VIRIDIS = {
      0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725};
  // By Okabe and Ito: people with any kind of colour vision can distinguish them.
  private static final int[] SERIES = {
      0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9, 0x5b4a8a, 0x8c6d31};
  static final int SERIES_COLOURS = SERIES.length;

  private Palette() {}

  /** Returns a colour of Viridis, from 0 (dark) to 1 (yellow). */
  static Color viridis(double fraction) {
    double position = Math.min(Math.max(fraction, 0), 1) * (VIRIDIS.length - 1);
    int lower = Math.min((int) position, VIRIDIS.length - 2);
    return between(new Color(VIRIDIS[lower]), new Color(VIRIDIS[lower + 1]), position - lower);
  }

  /** Returns a mixture: share 0 is the first colour, 1 the second. */
  static Color between(Color from, Color to, double share) {
    return new Color((int) Math.round(from.getRed() + (to.getRed() - from.getRed()) * share),
        (int) Math.round(from.getGreen() + (to.getGreen() - from.getGreen()) * share),
        (int) Math.round(from.getBlue() + (to.getBlue() - from.getBlue()) * share));
  }

  /** Returns the colour of a map's cell. Those of the report page are the same. */
  static Color ofCell(char kind) {
    return switch (kind) {
      case 'N' -> new Color(0xf2c4bd); // no flying
      case 'R' -> new Color(0xc4e3c0); // blocks radio
      case 'B' -> new Color(0xdfcb73); // both
      case 'S' -> new Color(0xc5d9f3); // start and landing
      default -> SURFACE;
    };
  }

  static Color series(int index) { return new Color(SERIES[Math.floorMod(index, SERIES.length)]); }

  /** Returns the stroke of a curve: dashed if all colours of `series` are taken already. */
  static Stroke seriesStroke(int index, double width) {
    return index < SERIES.length ? stroke(width) : dashed(width);
  }

  private static Stroke dashed(double width) {
    return new BasicStroke(
        (float) width, BasicStroke.CAP_BUTT, BasicStroke.JOIN_ROUND, 1, new float[] {6, 4}, 0);
  }

  static Color withAlpha(Color colour, int alpha) {
    return new Color(colour.getRed(), colour.getGreen(), colour.getBlue(), alpha);
  }

  /** Returns black or white, whichever is more legible on the colour. */
  static Color inkOn(Color colour) {
    double brightness = 0.299 * colour.getRed() + 0.587 * colour.getGreen() + 0.114 * colour.getBlue();
    return brightness > 140 ? INK : Color.WHITE;
  }

  static Stroke stroke(double width) {
    return new BasicStroke((float) width, BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND);
  }
}
