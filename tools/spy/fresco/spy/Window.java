package fresco.spy;

import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import javax.swing.JComponent;
import javax.swing.JFrame;
import javax.swing.Timer;

/**
 * A window that shows what arrives on a run's channels. Some times a second, it handles the messages of its
 * inbox and is painted again, until it is closed. Used on the event thread.
 */
abstract class Window {
  private final JFrame frame = new JFrame();
  private final Inbox inbox = new Inbox();
  private final Timer timer;
  private long lastTickNs = System.nanoTime();

  Window(int periodMs) { timer = new Timer(periodMs, event -> tick()); }

  Inbox inbox() { return inbox; }

  void setTitle(String title) {
    if (!title.equals(frame.getTitle())) {
      frame.setTitle(title);
    }
  }

  /** Shows the window and starts its timer. */
  void open(String title, JComponent content, Dimension size) {
    content.setBackground(Palette.PAPER);
    frame.setTitle(title);
    frame.getContentPane().add(content, BorderLayout.CENTER);
    frame.setSize(size);
    frame.setLocationByPlatform(true);
    frame.setDefaultCloseOperation(JFrame.DISPOSE_ON_CLOSE);
    frame.addWindowListener(new WindowAdapter() {
      @Override
      public void windowClosed(WindowEvent event) {
        timer.stop();
        inbox.close();
        closed();
      }
    });
    frame.setVisible(true);
    timer.start();
  }

  private void tick() {
    long now = System.nanoTime();
    double seconds = (now - lastTickNs) * 1e-9;
    lastTickNs = now;
    inbox.drain();
    update(seconds);
  }

  /** Called after messages were handled, so many seconds after the last call. */
  abstract void update(double seconds);

  /** Called when the window was closed. */
  void closed() {}
}
