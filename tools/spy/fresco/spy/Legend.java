package fresco.spy;

import info.monitorenter.gui.chart.ITrace2D;
import java.awt.Component;
import java.awt.Dimension;
import java.awt.Font;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.util.Collection;
import javax.swing.BorderFactory;
import javax.swing.BoxLayout;
import javax.swing.Icon;
import javax.swing.JLabel;
import javax.swing.JPanel;

/** The names of a chart's curves, one below the other, each behind a piece of its line. */
final class Legend extends JPanel {
  private static final long serialVersionUID = 1;
  private static final int WIDEST = 150;
  private static final int LINE_PIXELS = 18;
  private static final int LINE_HEIGHT = 12;

  Legend(Collection<ITrace2D> traces) {
    setLayout(new BoxLayout(this, BoxLayout.Y_AXIS));
    setOpaque(false);
    setBorder(BorderFactory.createEmptyBorder(0, 4, 0, 0));
    for (ITrace2D trace : traces) {
      JLabel label = new JLabel();
      label.putClientProperty("html.disable", true); // names come from the network
      label.setText(trace.getName());
      label.setIcon(new Line(trace));
      label.setForeground(Palette.MUTED);
      label.setFont(label.getFont().deriveFont(Font.PLAIN, 10f));
      add(label);
    }
  }

  @Override
  public Dimension getPreferredSize() {
    Dimension size = super.getPreferredSize();
    return new Dimension(Math.min(size.width, WIDEST), size.height);
  }

  /** A piece of a curve. */
  private record Line(ITrace2D trace) implements Icon {
    @Override
    public void paintIcon(Component on, Graphics graphics, int x, int y) {
      Graphics2D g = (Graphics2D) graphics.create();
      g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
      g.setColor(trace.getColor());
      g.setStroke(trace.getStroke());
      g.drawLine(x, y + LINE_HEIGHT / 2, x + LINE_PIXELS, y + LINE_HEIGHT / 2);
      g.dispose();
    }

    @Override
    public int getIconWidth() {
      return LINE_PIXELS + 2;
    }

    @Override
    public int getIconHeight() {
      return LINE_HEIGHT;
    }
  }
}
