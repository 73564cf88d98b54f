package fresco.spy;

import fresco.flight_t;
import fresco.transitions_t;
import fresco.world_t;
import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.FlowLayout;
import javax.swing.JComboBox;
import javax.swing.JLabel;
import javax.swing.JPanel;
import javax.swing.JToggleButton;

/** Shows flights: episodes of a run, and those of `fresco fly`. Used on the event thread. */
final class FlightWindow extends Window {
  private static final int PERIOD_MS = 40;
  private static final Integer[] PACES = {2, 4, 8, 16, 32};

  private final Worlds worlds = new Worlds();
  private final Fields fields = new Fields();
  private final Orders orders = new Orders();
  private final Episodes episodes = new Episodes();
  private final LiveFlights liveFlights = new LiveFlights();
  private final Player player = new Player();
  private final FieldPanel map = new FieldPanel();
  private final AoiChart chart = new AoiChart();
  private final FlightFacts facts = new FlightFacts();
  private final String prefix;
  private String otherWorld = ""; // of the run heard last; empty: none, or the UAV's

  FlightWindow(String prefix) {
    super(PERIOD_MS);
    this.prefix = prefix;
    inbox().subscribe(prefix + "_WORLD", MessageTypes.WORLD, this::add);
    inbox().subscribe(prefix + "_SCENARIO", MessageTypes.SCENARIO, fields::add);
    inbox().subscribe(prefix + "_ORDERS", MessageTypes.ORDERS, orders::add);
    inbox().subscribe(prefix + "_TRANSITIONS", MessageTypes.TRANSITIONS, this::add);
    inbox().subscribe(prefix + "_FLIGHT", MessageTypes.FLIGHT, this::add);
    open("Fresco flight", content(), new Dimension(1240, 780));
  }

  private JPanel content() {
    JPanel right = new JPanel(new BorderLayout(0, 8));
    right.setOpaque(false);
    right.add(facts.component(), BorderLayout.NORTH);
    right.add(chart.component(), BorderLayout.CENTER);
    right.setPreferredSize(new Dimension(470, 700));
    JPanel content = new JPanel(new BorderLayout(4, 4));
    content.add(controls(), BorderLayout.NORTH);
    content.add(map, BorderLayout.CENTER);
    content.add(right, BorderLayout.EAST);
    return content;
  }

  private JPanel controls() {
    JComboBox<Player.Choice> choice = new JComboBox<>(Player.Choice.values());
    choice.addActionListener(event -> player.choose((Player.Choice) choice.getSelectedItem()));
    JComboBox<Integer> pace = new JComboBox<>(PACES);
    pace.setSelectedItem(8);
    pace.addActionListener(event -> player.setSlotsPerS((Integer) pace.getSelectedItem()));
    JToggleButton pause = new JToggleButton("pause");
    pause.addActionListener(event -> player.setPaused(pause.isSelected()));
    JPanel controls = new JPanel(new FlowLayout(FlowLayout.LEFT, 8, 4));
    controls.setOpaque(false);
    controls.add(new JLabel("show"));
    controls.add(choice);
    controls.add(new JLabel("slots a second"));
    controls.add(pace);
    controls.add(pause);
    return controls;
  }

  private void add(world_t message) {
    worlds.add(message);
    WorldNames names = worlds.of(message.run_id);
    otherWorld = names == null || names.isUav() ? "" : names.world();
  }

  private void add(transitions_t message) {
    WorldNames names = worlds.of(message.run_id);
    if (names == null || !names.isUav()) {
      return;
    }
    Episode flown = episodes.add(message, names);
    if (flown != null) {
      Flight episode = Flight.of(flown);
      episode.kind = orders.describe(episode.runId, episode.number);
      player.offer(episode, orders.isEvaluation(episode.runId, episode.number));
    }
  }

  private void add(flight_t message) {
    Flight live = liveFlights.add(message);
    if (live != null) {
      player.follow(live);
    }
  }

  @Override
  void update(double seconds) {
    player.tick(seconds);
    Flight flight = player.flight();
    if (flight == null) {
      map.showMissing(whatIsMissing());
      return;
    }
    setTitle(String.format("Fresco flight: %s, run %016x", flight.kind, flight.runId));
    Field field = fields.of(flight.runId);
    boolean fits = field != null && field.sensors().size() == flight.sensors();
    facts.show(flight, player.shownSteps(), fits ? field : null);
    chart.show(flight, player.shownSteps(), fits ? field.slots() : flight.steps.size());
    if (fits) {
      map.show(field, flight, player.position());
    } else {
      map.showMissing("waiting for the field of this run on " + prefix + "_SCENARIO");
    }
  }

  private String whatIsMissing() {
    return otherWorld.isEmpty()
        ? String.format("waiting for flights on %s_TRANSITIONS and %s_FLIGHT", prefix, prefix)
        : "the world \"" + otherWorld + "\" has no flights; fresco spy --open episode shows its episodes";
  }

  @Override
  void closed() {
    chart.component().close();
  }
}
