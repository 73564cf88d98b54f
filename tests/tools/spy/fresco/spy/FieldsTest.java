package fresco.spy;

import static org.junit.Assert.assertArrayEquals;
import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertNotNull;
import static org.junit.Assert.assertNull;

import fresco.scenario_t;
import java.util.List;
import java.util.function.Consumer;
import org.junit.Test;

public class FieldsTest {
  private final Fields fields = new Fields();

  @Test
  public void knowAFieldOnceEverySensorWasHeardOf() {
    fields.add(Messages.scenario(1, 48, 2, 50));
    assertNull(fields.of(1));
    fields.add(Messages.scenario(1, 0, 48, 50));
    assertEquals(50, fields.of(1).sensors().size());
    assertEquals(50, fields.of(1).sensors().get(49).weight(), 0);
    assertNull(fields.of(2));
  }

  @Test
  public void weighSensorsRelativeToEachOther() {
    fields.add(Messages.scenario(1, 0, 3, 3));
    assertArrayEquals(new double[] {1 / 6.0, 2 / 6.0, 3 / 6.0}, fields.of(1).theta(), 1e-12);
  }

  @Test
  public void leaveOutWhatNoScenarioCanBe() {
    List<Consumer<scenario_t>> faults = List.of(message
        -> message.columns = 0,
        message
        -> message.rows = 2_000_000,
        message
        -> message.cell_m = Double.NaN,
        message
        -> message.cell_m = -1,
        message
        -> message.coverage_radius_m = Double.POSITIVE_INFINITY,
        message
        -> message.start_row = 20,
        message
        -> message.stop_column = -1,
        message
        -> message.slots = 0,
        message
        -> message.total_sensors = 2,
        message
        -> message.total_sensors = Integer.MAX_VALUE,
        message
        -> message.first_sensor = -1,
        message
        -> message.first_sensor = Integer.MAX_VALUE,
        message -> message.x_m[1] = Double.NaN, message -> message.weight[2] = -1);
    for (Consumer<scenario_t> fault : faults) {
      scenario_t message = Messages.scenario(3, 0, 3, 3);
      fault.accept(message);
      fields.add(message);
      assertNull(fields.of(3));
    }
  }

  @Test
  public void forgetRunsThatAreLongGone() {
    for (int run = 0; run < 1000; ++run) {
      fields.add(Messages.scenario(run, 0, 3, 3));
    }
    assertNull(fields.of(0));
    assertNotNull(fields.of(999));
  }
}
