package fresco.spy;

import static org.junit.Assert.assertEquals;

import java.util.ArrayList;
import java.util.List;
import java.util.stream.IntStream;
import org.junit.Test;

public class FieldGroupsTest {
  private static List<Quantity> fields(String unit, int count) {
    return IntStream.range(0, count).mapToObj(i -> new Quantity("field_" + i, unit)).toList();
  }

  private static List<Integer> sizes(FieldGroups groups) {
    return groups.groups.stream().map(group -> group.fields().size()).toList();
  }

  @Test
  public void putFieldsOfOneUnitTogether() {
    FieldGroups groups = new FieldGroups(
        List.of(new Quantity("x", "m"), new Quantity("speed", "m/s"), new Quantity("y", "m")));
    assertEquals(List.of(0, 2), groups.groups.get(0).fields());
    assertEquals("X, y", groups.groups.get(0).heading());
    assertEquals("m", groups.groups.get(0).unit());
    assertEquals(List.of(1), groups.groups.get(1).fields());
    assertEquals(0, groups.leftOut);
  }

  @Test
  public void useTheRoomForFurtherFieldsOfOneUnit() {
    FieldGroups groups = new FieldGroups(fields("", 30));
    assertEquals(List.of(12, 12, 6), sizes(groups));
    assertEquals("Field 12 to field 23 (12 of 30)", groups.groups.get(1).heading());
    assertEquals(0, groups.leftOut);
  }

  @Test
  public void leaveRoomForEveryUnit() {
    List<Quantity> state = new ArrayList<>(fields("m", 200));
    state.addAll(fields("s", 1));
    FieldGroups groups = new FieldGroups(state);
    assertEquals(List.of(12, 12, 12, 12, 12, 12, 1), sizes(groups));
    assertEquals(128, groups.leftOut);
  }

  @Test
  public void areNoMoreThanCanBeShown() {
    List<Quantity> state = new ArrayList<>();
    IntStream.range(0, 20).forEach(unit -> state.addAll(fields("unit " + unit, 2)));
    FieldGroups groups = new FieldGroups(state);
    assertEquals(List.of(2, 2, 2, 2, 2, 2, 2), sizes(groups));
    assertEquals(26, groups.leftOut);
  }
}
