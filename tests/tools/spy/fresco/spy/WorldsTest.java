package fresco.spy;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertFalse;
import static org.junit.Assert.assertNotNull;
import static org.junit.Assert.assertNull;
import static org.junit.Assert.assertSame;
import static org.junit.Assert.assertTrue;

import fresco.world_t;
import java.util.List;
import java.util.function.Consumer;
import org.junit.Test;

public class WorldsTest {
  private final Worlds worlds = new Worlds();

  private static world_t cart(long run) {
    return Messages.world(run, "cart", List.of("position [m]", "angular_velocity [rad/s]"), 3, 500);
  }

  @Test
  public void areKnownOnceEveryPartWasHeard() {
    worlds.add(Messages.part(cart(1), 4, 2));
    worlds.add(Messages.part(cart(1), 0, 1));
    assertNull(worlds.of(1));
    worlds.add(Messages.part(cart(1), 1, 3));
    WorldNames names = worlds.of(1);
    assertEquals("cart", names.world());
    assertEquals(
        List.of(new Quantity("position", "m"), new Quantity("angular_velocity", "rad/s")), names.state());
    assertEquals(List.of("action 0", "action 1", "action 2"), names.actions());
    assertEquals(new Quantity("average_aoi", "slots"), names.score());
    assertTrue(names.lessIsBetter());
    assertFalse(names.isUav());
    assertNull(worlds.of(2));
    worlds.add(Messages.part(cart(1), 1, 3));
    assertSame(names, worlds.of(1));
  }

  @Test
  public void keepRunsApart() {
    worlds.add(Messages.part(cart(1), 0, 4));
    worlds.add(Messages.part(cart(2), 4, 2));
    assertNull(worlds.of(1));
    assertNull(worlds.of(2));
  }

  @Test
  public void beginAgainWhereAMessageContradicts() {
    worlds.add(Messages.part(cart(1), 0, 4));
    world_t other = Messages.part(cart(1), 4, 2);
    other.config_hash = 5;
    worlds.add(other);
    assertNull(worlds.of(1));
  }

  @Test
  public void leaveOutWhatNoWorldCanBe() {
    List<Consumer<world_t>> faults = List.of(message
        -> message.state_size = 0,
        message
        -> message.state_size = Integer.MAX_VALUE,
        message
        -> message.action_count = 4001,
        message
        -> message.figure_count = 101,
        message
        -> message.figure_count = 0,
        message
        -> message.longest_episode = 0,
        message
        -> message.longest_episode = 100_001,
        message
        -> message.first_entry = 1,
        message
        -> message.first_entry = -1,
        message
        -> message.first_entry = Integer.MAX_VALUE,
        message
        -> message.entry_count = 7,
        message
        -> message.entry_count = 0,
        message -> message.entry_count = Integer.MIN_VALUE, message -> message.entries += "more\n");
    for (Consumer<world_t> fault : faults) {
      world_t message = cart(3);
      fault.accept(message);
      worlds.add(message);
      assertNull(worlds.of(3));
    }
    worlds.add(cart(3));
    assertNotNull(worlds.of(3));
  }

  @Test
  public void forgetRunsThatAreLongGone() {
    for (int run = 0; run < 1000; ++run) {
      worlds.add(cart(run));
    }
    assertNull(worlds.of(0));
    assertNotNull(worlds.of(999));
  }

  @Test
  public void nameQuantitiesForPeople() {
    assertEquals("average AoI, slots", Quantity.of("average_aoi [slots]").labelAndUnit());
    assertEquals("energy margin", Quantity.of("energy_margin_j [J]").label());
    assertEquals("return", Quantity.of("return").labelAndUnit());
    assertEquals("12.346 slots", Quantity.of("average_aoi [slots]").text(12.3456));
    assertEquals("-", Quantity.of("average_aoi [slots]").text(Double.NaN));
    assertEquals("swung up", Quantity.inWords("swung_up"));
    assertEquals("[m]", Quantity.of("[m]").name());
  }
}
