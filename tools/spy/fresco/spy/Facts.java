package fresco.spy;

import java.awt.Color;
import java.awt.Font;
import java.awt.GridBagConstraints;
import java.awt.GridBagLayout;
import java.awt.Insets;
import java.util.LinkedHashMap;
import java.util.Map;
import javax.swing.BorderFactory;
import javax.swing.JLabel;
import javax.swing.JPanel;

/** A list of names and values in one or more columns. Used on the event thread. */
final class Facts extends JPanel {
  private static final long serialVersionUID = 1;

  private final transient Map<String, JLabel> values = new LinkedHashMap<>();

  /** @param columns pairs side by side, filled from left to right */
  Facts(int columns, String... names) {
    super(new GridBagLayout());
    setBackground(Palette.SURFACE);
    setBorder(BorderFactory.createEmptyBorder(8, 12, 8, 12));
    for (int i = 0; i < names.length; ++i) {
      int column = 2 * (i % columns);
      add(label(names[i], Palette.MUTED, Font.PLAIN), at(column, i / columns, 0));
      JLabel value = label("-", Palette.INK, Font.BOLD);
      add(value, at(column + 1, i / columns, 1));
      values.put(names[i], value);
    }
  }

  private static GridBagConstraints at(int column, int row, double weight) {
    Insets insets = new Insets(2, column % 2 == 0 ? 4 : 10, 2, 8);
    return new GridBagConstraints(
        column, row, 1, 1, weight, 0, GridBagConstraints.WEST, GridBagConstraints.HORIZONTAL, insets, 0, 0);
  }

  private static JLabel label(String text, Color colour, int style) {
    JLabel label = new JLabel(text);
    label.putClientProperty("html.disable", true); // texts come from the network
    label.setForeground(colour);
    label.setFont(label.getFont().deriveFont(style, 13f));
    return label;
  }

  void set(String name, String value) { set(name, value, Palette.INK); }

  void set(String name, String value, Color colour) {
    JLabel label = values.get(name);
    label.setText(value);
    label.setToolTipText(null);
    label.setForeground(colour);
  }
}
