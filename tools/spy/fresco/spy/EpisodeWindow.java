package fresco.spy;

import fresco.transitions_t;
import java.awt.BorderLayout;
import java.awt.CardLayout;
import java.awt.Component;
import java.awt.Dimension;
import java.awt.FlowLayout;
import java.awt.Font;
import javax.swing.BorderFactory;
import javax.swing.JComboBox;
import javax.swing.JLabel;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JTable;
import javax.swing.JToggleButton;
import javax.swing.SwingConstants;
import javax.swing.table.DefaultTableCellRenderer;

/** Shows episodes of a run in any world: every state, the rewards, the actions. Used on the event thread. */
final class EpisodeWindow extends Window {
  private static final int PERIOD_MS = 100;
  private static final String WAITING = "waiting";
  private static final String EPISODE = "episode";
  private static final int[] COLUMN_WIDTHS = {60, 210, 70, 70};

  private final Worlds worlds = new Worlds();
  private final Orders orders = new Orders();
  private final Episodes episodes = new Episodes();
  private final EpisodeChoice choice = new EpisodeChoice();
  private final EpisodeCharts charts = new EpisodeCharts();
  private final EpisodeFacts facts = new EpisodeFacts();
  private final ActionTable actions = new ActionTable();
  private final RunFollower run = new RunFollower(System::nanoTime);
  private final CardLayout cards = new CardLayout();
  private final JPanel content = new JPanel(cards);
  private final JLabel waiting = new JLabel("", SwingConstants.CENTER);
  private final String prefix;

  EpisodeWindow(String prefix) {
    super(PERIOD_MS);
    this.prefix = prefix;
    inbox().subscribe(prefix + "_WORLD", MessageTypes.WORLD, worlds::add);
    inbox().subscribe(prefix + "_ORDERS", MessageTypes.ORDERS, orders::add);
    inbox().subscribe(prefix + "_TRANSITIONS", MessageTypes.TRANSITIONS, this::add);
    waiting.setForeground(Palette.MUTED);
    waiting.setFont(waiting.getFont().deriveFont(Font.PLAIN, 15f));
    content.add(waiting, WAITING);
    content.add(episode(), EPISODE);
    open("Fresco episode", content, new Dimension(1240, 800));
  }

  private JPanel episode() {
    JPanel right = new JPanel(new BorderLayout(0, 8));
    right.setOpaque(false);
    right.add(facts.component(), BorderLayout.NORTH);
    right.add(actionsTaken(), BorderLayout.CENTER);
    right.setPreferredSize(new Dimension(410, 700));
    JPanel panel = new JPanel(new BorderLayout(4, 4));
    panel.setBackground(Palette.PAPER);
    panel.add(controls(), BorderLayout.NORTH);
    panel.add(charts.component(), BorderLayout.CENTER);
    panel.add(right, BorderLayout.EAST);
    return panel;
  }

  private JScrollPane actionsTaken() {
    JTable view = new JTable(actions);
    view.setRowHeight(22);
    view.setShowVerticalLines(false);
    view.setDefaultRenderer(Object.class, new Renderer());
    for (int column = 0; column < COLUMN_WIDTHS.length; ++column) {
      view.getColumnModel().getColumn(column).setPreferredWidth(COLUMN_WIDTHS[column]);
    }
    JScrollPane scroll = new JScrollPane(view);
    scroll.setBorder(BorderFactory.createEmptyBorder());
    scroll.getViewport().setBackground(Palette.PAPER); // a world with few actions leaves much of it free
    return scroll;
  }

  /** Writes numbers to the right, names to the left, with room between them. */
  private static final class Renderer extends DefaultTableCellRenderer {
    private static final long serialVersionUID = 1;

    Renderer() {
      putClientProperty("html.disable", true); // texts come from the network
    }

    @Override
    public Component getTableCellRendererComponent(
        JTable view, Object value, boolean selected, boolean focused, int row, int column) {
      super.getTableCellRendererComponent(view, value, selected, focused, row, column);
      setHorizontalAlignment(column == 1 ? SwingConstants.LEFT : SwingConstants.RIGHT);
      setBorder(BorderFactory.createEmptyBorder(0, 10, 0, 10));
      return this;
    }
  }

  private JPanel controls() {
    JComboBox<EpisodeChoice.Kind> kind = new JComboBox<>(EpisodeChoice.Kind.values());
    kind.addActionListener(event -> choice.choose((EpisodeChoice.Kind) kind.getSelectedItem()));
    JToggleButton pause = new JToggleButton("pause");
    pause.addActionListener(event -> choice.setPaused(pause.isSelected()));
    JPanel controls = new JPanel(new FlowLayout(FlowLayout.LEFT, 8, 4));
    controls.setOpaque(false);
    controls.add(new JLabel("show"));
    controls.add(kind);
    controls.add(pause);
    return controls;
  }

  private void add(transitions_t message) {
    RunFollower.Hearing hearing = run.hear(message.run_id);
    if (hearing == RunFollower.Hearing.OTHER) {
      return;
    }
    if (hearing == RunFollower.Hearing.NEW) {
      choice.clear();
    }
    Episode episode = episodes.add(message, worlds.of(message.run_id));
    if (episode != null) {
      choice.offer(episode, orders.isEvaluation(episode.runId(), episode.order()));
    }
  }

  @Override
  void update(double seconds) {
    waiting.setText(worlds.of(run.runId()) == null
            ? String.format("waiting for a run on %s_WORLD and %s_TRANSITIONS", prefix, prefix)
            : String.format("waiting for a complete episode on %s_TRANSITIONS", prefix));
    Episode episode = choice.tick(seconds);
    if (episode != null) {
      show(episode);
    }
  }

  private void show(Episode episode) {
    setTitle(String.format(
        "Fresco episode: %s, run %016x on %s", episode.names().world(), episode.runId(), prefix));
    charts.show(episode);
    facts.show(episode, orders.describe(episode.runId(), episode.order()));
    actions.show(episode);
    cards.show(content, EPISODE);
  }

  @Override
  void closed() {
    charts.close();
  }
}
