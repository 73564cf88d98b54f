package fresco.spy;

import java.awt.AWTError;
import java.awt.GraphicsEnvironment;
import java.awt.HeadlessException;
import java.io.IOException;
import java.util.ArrayDeque;
import java.util.Arrays;
import java.util.Deque;
import java.util.List;
import java.util.Locale;
import javax.swing.UIManager;
import lcm.spy.Spy;

/**
 * Starts lcm-spy with Fresco's types and windows. `fresco spy` runs it with four arguments: the LCM URL, the
 * channels' prefix, the windows to open (comma-separated, may be empty), and whether to print the table.
 */
public final class Main {
  private static final int FAILED = 1;
  private static final int WRONG_USE = 2;

  private Main() {}

  public static void main(String[] arguments) {
    Locale.setDefault(Locale.ROOT);
    try {
      start(new ArrayDeque<>(List.of(arguments)));
    } catch (AWTError | NoClassDefFoundError | HeadlessException error) {
      fail(WRONG_USE,
          "no window can be opened: is there a display, and a full Java (default-jre)? "
              + error.getMessage());
    } catch (Exception error) {
      fail(FAILED, error.toString());
    }
  }

  private static void start(Deque<String> arguments) throws Exception {
    String url = arguments.remove();
    String prefix = arguments.remove();
    String open = arguments.remove();
    boolean print = Boolean.parseBoolean(arguments.remove());
    if (GraphicsEnvironment.isHeadless()) {
      throw new HeadlessException("Java has no graphics here");
    }
    UIManager.put("swing.boldMetal", false);
    connect(url);
    Spy spy = new Spy(url);
    if (print) {
      new ChannelTable(spy).start();
    }
    Arrays.stream(open.split(","))
        .filter(name -> !name.isEmpty())
        .map(Main::window)
        .forEach(w -> w.open(prefix));
  }

  private static void connect(String url) {
    try {
      Inbox.connect(url);
    } catch (IOException error) {
      fail(WRONG_USE, "can't open the LCM URL " + url + ": " + error.getMessage());
    }
  }

  private static Windows window(String name) { return Windows.valueOf(name.toUpperCase(Locale.ROOT)); }

  private static void fail(int status, String message) {
    System.err.println("fresco: error: spy: " + message);
    System.exit(status);
  }
}
