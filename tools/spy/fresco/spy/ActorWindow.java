package fresco.spy;

import fresco.actor_status_t;
import info.monitorenter.gui.chart.ITrace2D;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Component;
import java.awt.Dimension;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JTable;
import javax.swing.SwingConstants;
import javax.swing.table.DefaultTableCellRenderer;

/** Shows a run's actors: the status of each, and how fast it flies. Used on the event thread. */
final class ActorWindow extends Window {
  private static final int PERIOD_MS = 500;
  private static final double SHOWN_S = 120;

  private final ActorTable table = new ActorTable();
  private final Curves rates =
      new Curves("Transitions flown", "seconds since the window was opened", "transitions a second");
  private final Map<Long, ITrace2D> traces = new HashMap<>();
  private final ITrace2D sum = rates.add("all", Palette.INK, 2.2);
  private final RunFollower run = new RunFollower(System::nanoTime);
  private final String prefix;
  private double elapsedS;
  private double nextPointS;

  ActorWindow(String prefix) {
    super(PERIOD_MS);
    this.prefix = prefix;
    inbox().subscribe(prefix + "_ACTOR_STATUS", MessageTypes.ACTOR_STATUS, this::add);
    open("Fresco actors: waiting on " + prefix + "_ACTOR_STATUS", content(), new Dimension(1240, 620));
  }

  private JPanel content() {
    JTable view = new JTable(table);
    view.setRowHeight(22);
    view.setShowVerticalLines(false);
    view.setDefaultRenderer(Object.class, new Renderer());
    for (int column = 0; column < table.getColumnCount(); ++column) {
      view.getColumnModel().getColumn(column).setPreferredWidth(table.width(column));
    }
    view.setFillsViewportHeight(true);
    JScrollPane scroll = new JScrollPane(view);
    scroll.setPreferredSize(new Dimension(1200, 180));
    JPanel content = new JPanel(new BorderLayout(8, 8));
    content.add(scroll, BorderLayout.NORTH);
    content.add(rates, BorderLayout.CENTER);
    return content;
  }

  /** Draws silent actors pale. */
  private final class Renderer extends DefaultTableCellRenderer {
    private static final long serialVersionUID = 1;

    Renderer() {
      putClientProperty("html.disable", true); // texts come from the network
    }

    @Override
    public Component getTableCellRendererComponent(
        JTable view, Object value, boolean selected, boolean focused, int row, int column) {
      super.getTableCellRendererComponent(view, value, selected, focused, row, column);
      setHorizontalAlignment(column < 2 ? SwingConstants.LEFT : SwingConstants.RIGHT);
      if (!selected) {
        setForeground(table.rows().get(row).isSilent() ? Palette.LINE.darker() : Palette.INK);
      }
      return this;
    }
  }

  private void add(actor_status_t status) {
    if (status.run_id == 0 || status.actor_id == 0) { // it looks for a run
      return;
    }
    RunFollower.Hearing hearing = run.hear(status.run_id);
    if (hearing == RunFollower.Hearing.NEW) {
      table.clear();
    }
    if (hearing != RunFollower.Hearing.OTHER) {
      table.add(status);
    }
  }

  @Override
  void update(double seconds) {
    elapsedS += seconds;
    table.refresh();
    if (!table.rows().isEmpty()) {
      setTitle(String.format("Fresco actors: run %016x on %s", run.runId(), prefix));
    }
    if (elapsedS >= nextPointS) {
      nextPointS = elapsedS + 1;
      addPoints();
    }
  }

  private void addPoints() {
    rates.setXRange(Math.max(0, elapsedS - SHOWN_S), Math.max(SHOWN_S, elapsedS));
    double total = 0;
    for (ActorTable.Actor actor : table.rows()) {
      double rate = actor.transitionsPerS();
      if (rate >= 0 && rate < 1e12) {
        total += rate;
        ITrace2D trace = traceOf(actor);
        if (trace != null) {
          trace.addPoint(elapsedS, rate);
        }
      }
    }
    sum.addPoint(elapsedS, total);
    rates.fitY();
    forgetThoseThatAreGone();
  }

  /** Returns the actor's curve; null if there are no more colours. */
  private ITrace2D traceOf(ActorTable.Actor actor) {
    ITrace2D trace = traces.get(actor.status.actor_id);
    if (trace == null && traces.size() < Palette.SERIES_COLOURS) {
      String id = String.format("%016x", actor.status.actor_id);
      trace = rates.add("actor .." + id.substring(12), freeColour(), 1.5);
      traces.put(actor.status.actor_id, trace);
    }
    return trace;
  }

  private Color freeColour() {
    List<Color> taken = traces.values().stream().map(ITrace2D::getColor).toList();
    int index = 0;
    while (taken.contains(Palette.series(index))) {
      ++index;
    }
    return Palette.series(index);
  }

  private void forgetThoseThatAreGone() {
    traces.entrySet().removeIf(entry -> {
      boolean gone = table.rows().stream().noneMatch(actor -> actor.status.actor_id == entry.getKey());
      if (gone) {
        rates.remove(entry.getValue());
      }
      return gone;
    });
  }

  @Override
  void closed() {
    rates.close();
  }
}
