package fresco.spy;

import java.lang.reflect.Field;
import java.util.ArrayList;
import java.util.List;
import javax.swing.Timer;
import lcm.spy.ChannelData;
import lcm.spy.Spy;

/**
 * Prints lcm-spy's table on standard output once a second, a line for each channel: its name, type, and the
 * numbers of received and of undecodable messages. lcm-spy keeps it private, so it is read by reflection.
 */
final class ChannelTable {
  private static final int PERIOD_MS = 1000;

  private final List<ChannelData> channels;

  @SuppressWarnings("unchecked")
  ChannelTable(Spy spy) throws ReflectiveOperationException {
    Field list = Spy.class.getDeclaredField("channelList");
    list.setAccessible(true);
    channels = (List<ChannelData>) list.get(spy);
  }

  void start() { new Timer(PERIOD_MS, event -> print()).start(); }

  private void print() {
    List<ChannelData> now;
    synchronized (channels) { // as lcm-spy does when it adds one
      now = new ArrayList<>(channels);
    }
    for (ChannelData channel : now) {
      String type = channel.cls == null ? "?" : channel.cls.getSimpleName();
      System.out.printf("%s %s %d %d%n", channel.name, type, channel.nreceived, channel.nerrors);
    }
    System.out.println();
  }
}
