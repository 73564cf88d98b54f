package fresco.spy;

import fresco.actor_status_t;
import fresco.chunk_range_t;
import java.util.ArrayList;
import java.util.Comparator;
import java.util.List;
import java.util.Map;
import javax.swing.table.AbstractTableModel;

/** The newest status of every actor of a run, as the rows of a table. Used on the event thread. */
final class ActorTable extends AbstractTableModel {
  private static final long serialVersionUID = 1;
  private static final int MOST_ACTORS = 256;
  private static final double SILENT_S = 3;
  private static final double FORGOTTEN_S = 60;

  /** An actor and when its last status came. */
  static final class Actor {
    final actor_status_t status;
    final long heardNs;

    Actor(actor_status_t status, long heardNs) {
      this.status = status;
      this.heardNs = heardNs;
    }

    double silentS() { return (System.nanoTime() - heardNs) * 1e-9; }

    boolean isSilent() { return silentS() > SILENT_S; }

    double transitionsPerS() { return isSilent() ? 0 : status.transitions_per_s; }

    private long missingChunks() {
      long missing = 0;
      for (chunk_range_t range : status.missing) {
        missing += Math.max(0, range.count);
      }
      return missing;
    }
  }

  private interface Cell {
    Object of(Actor actor);
  }

  private record Column(String title, int width, Cell cell) {}

  private static final Column[] COLUMNS = {
      new Column("actor", 150, actor -> String.format("%016x", actor.status.actor_id)),
      new Column("host", 120, actor -> actor.status.host),
      new Column("process", 70, actor -> actor.status.pid),
      new Column("transitions/s", 100, actor -> String.format("%,.0f", actor.transitionsPerS())),
      new Column("transitions", 100, actor -> String.format("%,d", actor.status.transitions)),
      new Column("episodes", 80, actor -> String.format("%,d", actor.status.episodes)),
      new Column("orders/room", 90, actor -> actor.status.open_orders + "/" + actor.status.capacity),
      new Column("networks", 70, actor -> actor.status.held.length),
      new Column("chunks missing", 100, actor -> String.format("%,d", actor.missingChunks())),
      new Column("network latency", 110, actor -> Text.orDash("%.1f ms", actor.status.weights_latency_ms)),
      new Column("sent again", 80, actor -> String.format("%,d", actor.status.resent_episodes)),
      new Column("rejected", 70, actor -> String.format("%,d", actor.status.rejected_messages)),
      new Column("heard", 80, actor -> String.format("%.1f s ago", actor.silentS())),
  };

  private final transient Map<Long, Actor> actors = new RecentMap<>(MOST_ACTORS);
  private transient List<Actor> rows = new ArrayList<>();

  void add(actor_status_t status) { actors.put(status.actor_id, new Actor(status, System.nanoTime())); }

  void clear() { actors.clear(); }

  /** Shows the newest statuses. Forgets actors that have been silent for long. */
  void refresh() {
    actors.values().removeIf(actor -> actor.silentS() > FORGOTTEN_S);
    rows = new ArrayList<>(actors.values());
    rows.sort(Comparator.comparingLong(actor -> actor.status.actor_id));
    fireTableDataChanged();
  }

  List<Actor> rows() { return rows; }

  int width(int column) { return COLUMNS[column].width; }

  @Override
  public int getRowCount() {
    return rows.size();
  }

  @Override
  public int getColumnCount() {
    return COLUMNS.length;
  }

  @Override
  public String getColumnName(int column) {
    return COLUMNS[column].title;
  }

  @Override
  public Object getValueAt(int row, int column) {
    return COLUMNS[column].cell.of(rows.get(row));
  }
}
