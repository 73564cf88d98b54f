package fresco.spy;

import java.awt.Component;
import java.awt.GridLayout;
import java.util.List;
import javax.swing.JPanel;

/** Rows of components that fill all of the room, however many there are. Used on the event thread. */
final class Rows extends JPanel {
  private static final long serialVersionUID = 1;
  private static final int SPACE = 8;

  Rows() {
    super(new GridLayout(0, 1, SPACE, SPACE));
    setOpaque(false);
  }

  /** Shows these rows instead of all others. */
  void show(List<? extends List<? extends Component>> rows) {
    removeAll();
    for (List<? extends Component> row : rows) {
      JPanel panel = new JPanel(new GridLayout(1, 0, SPACE, SPACE));
      panel.setOpaque(false);
      row.forEach(panel::add);
      add(panel);
    }
    revalidate();
    repaint();
  }
}
