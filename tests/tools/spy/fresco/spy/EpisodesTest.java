package fresco.spy;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertNotNull;
import static org.junit.Assert.assertNull;

import fresco.transitions_t;
import org.junit.Test;

public class EpisodesTest {
  private static final int ARRIVED = 1;
  private final Episodes episodes = new Episodes();

  @Test
  public void areWholeInWhateverOrderTheirPartsCome() {
    assertNull(episodes.add(Messages.transitions(1, 9, 4, 2, ARRIVED)));
    assertNull(episodes.add(Messages.transitions(1, 9, 0, 3, 0)));
    Flight flight = episodes.add(Messages.transitions(1, 9, 3, 1, 0));
    assertEquals(7, flight.steps.size());
    for (int i = 0; i < 7; ++i) {
      assertEquals(i + 1, flight.steps.get(i).slot());
      assertEquals(i, flight.steps.get(i).column());
      assertEquals(2 * (i + 1), flight.steps.get(i).totalAoi());
    }
    assertEquals("east", flight.steps.get(5).moveName());
    assertEquals(1, flight.steps.get(5).scheduled());
    assertEquals(0, flight.steps.get(6).scheduled());
    assertEquals("arrived", flight.outcomeName());
    assertEquals(2 * (1 + 2 + 3), flight.totalAoi(3));
    assertEquals(2, flight.averageAoi(3, null), 1e-12);
  }

  @Test
  public void comeOnceHoweverOftenTheyAreSent() {
    assertNotNull(episodes.add(Messages.transitions(1, 9, 0, 3, ARRIVED)));
    assertNull(episodes.add(Messages.transitions(1, 9, 0, 3, ARRIVED)));
    assertNotNull(episodes.add(Messages.transitions(2, 9, 0, 3, ARRIVED)));
  }

  @Test
  public void keepApartWhatHasAnotherNumberOfSensors() {
    transitions_t other = Messages.transitions(1, 9, 0, 3, 0);
    other.sensor_count = 3;
    assertNull(episodes.add(other));
    assertNull(episodes.add(Messages.transitions(1, 9, 3, 3, ARRIVED)));
  }

  @Test
  public void leaveOutWhatNoEpisodeCanBe() {
    assertNull(episodes.add(Messages.transitions(1, 1, -1, 3, ARRIVED)));
    assertNull(episodes.add(Messages.transitions(1, 2, 20_000, 3, ARRIVED)));
    transitions_t inconsistent = Messages.transitions(1, 3, 0, 3, ARRIVED);
    inconsistent.state_count = 9;
    assertNull(episodes.add(inconsistent));
  }
}
