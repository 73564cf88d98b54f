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
    fields.add(Messages.scenario(1, 24, 2, 26));
    assertNull(fields.of(1));
    fields.add(Messages.scenario(1, 0, 24, 26));
    assertEquals(26, fields.of(1).sensors().size());
    assertEquals(26, fields.of(1).sensors().get(25).weight(), 0);
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
  public void knowAMapOnceEveryCellWasHeardOf() {
    String south = ".".repeat(200);
    String north = "N".repeat(100) + "R".repeat(50) + "B".repeat(49) + "S";
    fields.add(Messages.withCells(Messages.scenario(4, 0, 3, 3), 200, north, 400));
    assertNull(fields.of(4));
    fields.add(Messages.withCells(Messages.scenario(4, 3, 0, 3), 0, south, 400));
    assertEquals(400, fields.of(4).obstacles().kinds().length);
    assertEquals('.', fields.of(4).obstacles().kindOf(199));
    assertEquals('N', fields.of(4).obstacles().kindOf(200));
    assertEquals('S', fields.of(4).obstacles().kindOf(399));
  }

  @Test
  public void leaveOutWhatNoMapCanBe() {
    String cells = "R".repeat(400);
    List<Consumer<scenario_t>> faults = List.of(message
        -> message.total_cells = 399,
        message
        -> message.first_cell = 1,
        message
        -> message.first_cell = -1,
        message -> message.cell_kind[7] = 'x', message -> message.cell_kind[7] = 0);
    for (Consumer<scenario_t> fault : faults) {
      scenario_t message = Messages.withCells(Messages.scenario(5, 0, 3, 3), 0, cells, 400);
      fault.accept(message);
      fields.add(message);
      assertNull(fields.of(5));
    }
  }

  // A wall of two cells in the middle of a street, from west to east.
  @Test
  public void hideSensorsBehindWhatBlocksRadio() {
    byte[] kinds = ".....".repeat(5).getBytes(java.nio.charset.StandardCharsets.US_ASCII);
    kinds[2 * 5 + 1] = 'B';
    kinds[2 * 5 + 2] = 'R';
    Field.Sensor north = new Field.Sensor(50, 100, 1); // column 2, row 4
    Field.Sensor within = new Field.Sensor(50, 50, 1); // on the wall
    Obstacles wall = new Obstacles(5, kinds);
    Field field = new Field(5, 5, 25, new Field.Cell(0, 0), new Field.Cell(0, 0), 70, 1000, 1,
        List.of(north, within), wall);
    assertEquals(false, field.covers(2, 0, 0));
    assertEquals(false, field.covers(1, 0, 0)); // through both
    assertEquals(true, field.covers(3, 1, 0)); // past the corner
    assertEquals(true, field.covers(4, 2, 0));
    assertEquals(false, field.covers(2, 2, 0)); // over the wall
    assertEquals(true, field.covers(2, 2, 1));
    assertEquals(true, field.covers(2, 0, 1));
    assertEquals(false, field.covers(0, 2, 1)); // along the wall
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
