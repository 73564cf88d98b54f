package fresco.spy;

import java.util.ArrayList;
import java.util.Comparator;
import java.util.List;
import javax.swing.table.AbstractTableModel;

/** How often an episode took each action, the most frequent ones first. Used on the event thread. */
final class ActionTable extends AbstractTableModel {
  private static final long serialVersionUID = 1;
  private static final String[] TITLES = {"action", "name", "taken", "share"};

  private record Row(int action, String name, int taken, double share) {}

  private transient List<Row> rows = new ArrayList<>();

  void show(Episode episode) {
    int[] taken = new int[episode.names().actions().size()];
    for (short action : episode.actions()) {
      ++taken[action];
    }
    rows = new ArrayList<>();
    for (int i = 0; i < taken.length; ++i) {
      rows.add(new Row(i, episode.names().actions().get(i), taken[i], (double) taken[i] / episode.steps()));
    }
    rows.sort(Comparator.comparingInt(Row::taken).reversed().thenComparingInt(Row::action));
    fireTableDataChanged();
  }

  @Override
  public int getRowCount() {
    return rows.size();
  }

  @Override
  public int getColumnCount() {
    return TITLES.length;
  }

  @Override
  public String getColumnName(int column) {
    return TITLES[column];
  }

  @Override
  public Object getValueAt(int row, int column) {
    Row shown = rows.get(row);
    return switch (column) {
      case 0 -> Integer.toString(shown.action);
      case 1 -> shown.name;
      case 2 -> String.format("%,d", shown.taken);
      default -> String.format("%.0f %%", 100 * shown.share);
    };
  }
}
