package fresco.spy;

import java.util.function.Consumer;
import javax.swing.SwingUtilities;

/** The windows that there are, by the names that `fresco spy --open` takes. */
enum Windows {
  FLIGHT("Fresco: flight over the field", FlightWindow::new),
  LEARNER("Fresco: learner's curves", LearnerWindow::new),
  ACTORS("Fresco: actors", ActorWindow::new);

  private final String title;
  private final Consumer<String> opener;

  Windows(String title, Consumer<String> opener) {
    this.title = title;
    this.opener = opener;
  }

  String title() { return title; }

  /** Opens one for the channels of this prefix. From any thread. */
  void open(String prefix) { SwingUtilities.invokeLater(() -> opener.accept(prefix)); }
}
