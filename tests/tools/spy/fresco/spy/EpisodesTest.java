package fresco.spy;

import static org.junit.Assert.assertArrayEquals;
import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertNotNull;
import static org.junit.Assert.assertNull;

import fresco.transitions_t;
import java.util.Collections;
import java.util.List;
import java.util.function.Consumer;
import org.junit.Test;

public class EpisodesTest {
  private static final int TERMINAL = 1;
  private static final int TRUNCATED = 2;
  private final Episodes episodes = new Episodes();
  private final WorldNames uav = Messages.uav();

  private Episode add(transitions_t message) { return episodes.add(message, uav); }

  @Test
  public void areWholeInWhateverOrderTheirPartsCome() {
    assertNull(add(Messages.transitions(1, 9, 4, 2, TRUNCATED)));
    assertNull(add(Messages.transitions(1, 9, 0, 3, 0)));
    Episode episode = add(Messages.transitions(1, 9, 3, 1, 0));
    assertEquals(6, episode.steps());
    assertEquals(12, episode.sumOfRewards(), 0);
    assertEquals("cut off (truncated)", episode.endingName());
    for (int i = 0; i < 7; ++i) {
      assertArrayEquals(new float[] {i, 3, 4, 50, i + 1, i + 1}, episode.states()[i], 0);
    }
  }

  @Test
  public void ofTheUavAreFlights() {
    Flight flight = Flight.of(add(Messages.transitions(1, 9, 0, 6, TERMINAL)));
    assertEquals(7, flight.steps.size());
    for (int i = 0; i < 7; ++i) {
      assertEquals(i + 1, flight.steps.get(i).slot());
      assertEquals(i, flight.steps.get(i).column());
      assertEquals(2 * (i + 1), flight.steps.get(i).totalAoi());
    }
    assertEquals("east", flight.steps.get(5).moveName());
    assertEquals(1, flight.steps.get(5).scheduled());
    assertEquals("hover", flight.steps.get(6).moveName());
    assertEquals(0, flight.steps.get(6).scheduled());
    assertEquals("arrived", flight.outcomeName());
    assertEquals(2 * (1 + 2 + 3), flight.totalAoi(3));
    assertEquals(2, flight.averageAoi(3, null), 1e-12);
  }

  @Test
  public void ofTheUavEndAsTheirLastMarginsSay() {
    for (float[] margins : new float[][] {{-1, -1, 2}, {0, -1, 3}, {0, 0, 1}}) {
      transitions_t message = Messages.transitions(1, (long) margins[2], 0, 3, TERMINAL);
      message.state[3][2] = margins[0];
      message.state[3][3] = margins[1];
      assertEquals((int) margins[2], Flight.of(add(message)).outcome);
    }
  }

  @Test
  public void joinThePartsOfWideStates() {
    for (int step = 2; step >= 0; --step) {
      int ending = step == 2 ? TERMINAL : 0;
      assertNull(add(Messages.fields(Messages.transitions(1, 9, step, 1, ending), 0, 4)));
    }
    for (int step = 0; step < 2; ++step) {
      assertNull(add(Messages.fields(Messages.transitions(1, 9, step, 1, 0), 4, 2)));
    }
    Episode episode = add(Messages.fields(Messages.transitions(1, 9, 2, 1, TERMINAL), 4, 2));
    for (int i = 0; i < 4; ++i) {
      assertArrayEquals(new float[] {i, 3, 4, 50, i + 1, i + 1}, episode.states()[i], 0);
    }
  }

  @Test
  public void comeOnceHoweverOftenTheyAreSent() {
    assertNotNull(add(Messages.transitions(1, 9, 0, 3, TERMINAL)));
    assertNull(add(Messages.transitions(1, 9, 0, 3, TERMINAL)));
    assertNotNull(add(Messages.transitions(2, 9, 0, 3, TERMINAL)));
  }

  @Test
  public void beginAgainWhereAMessageContradicts() {
    transitions_t other = Messages.transitions(1, 9, 0, 3, 0);
    other.seed = 6;
    assertNull(add(other));
    assertNull(add(Messages.transitions(1, 9, 3, 3, TERMINAL)));
    assertNotNull(add(Messages.transitions(1, 9, 0, 3, 0)));
    assertNull(add(Messages.transitions(1, 10, 0, 3, 0)));
    assertNull(add(Messages.transitions(1, 10, 5, 3, 0)));
    assertNull(add(Messages.transitions(1, 10, 3, 3, TERMINAL))); // it ends before the last one
  }

  @Test
  public void leaveOutWhatNoEpisodeCanBe() {
    List<Consumer<transitions_t>> faults = List.of(message
        -> message.first_transition = -1,
        message
        -> message.first_transition = 20_000,
        message
        -> message.first_transition = Integer.MAX_VALUE,
        message
        -> message.state_count = 9,
        message
        -> message.field_count = 0,
        message
        -> message.field_count = 7,
        message
        -> message.first_field = 1,
        message
        -> message.first_field = -1,
        message
        -> message.first_field = Integer.MAX_VALUE,
        message
        -> message.ending = 3,
        message -> message.ending = -1, message -> message.action[1] = 15, message -> message.action[2] = -1);
    for (Consumer<transitions_t> fault : faults) {
      transitions_t message = Messages.transitions(1, 9, 0, 3, TERMINAL);
      fault.accept(message);
      assertNull(add(message));
    }
    assertNull(episodes.add(Messages.transitions(1, 9, 0, 3, TERMINAL), null));
    assertNotNull(add(Messages.transitions(1, 9, 0, 3, TERMINAL)));
  }

  @Test
  public void takeALimitedMemoryWhateverIsSent() {
    Worlds worlds = new Worlds();
    worlds.add(Messages.world(1, "wide", Collections.nCopies(10_000, "x"), 15, 100_000));
    WorldNames wide = worlds.of(1);
    for (int i = 0; i < 20_000; ++i) { // without a limit, 1.6 GB
      assertNull(episodes.add(Messages.transitions(1, i % 200, 2 * i, 1, 0), wide));
    }
  }
}
