package fresco.spy;

import java.util.ArrayList;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;

/** Decides which fields of a state are drawn in which chart: those of one unit together. Immutable. */
final class FieldGroups {
  static final int MOST_CHARTS = 7; // an eighth one shows the rewards
  static final int MOST_CURVES = 12; // in a chart
  private static final int LONGEST_HEADING = 44;

  /**
   * The fields of one chart.
   *
   * @param fields their numbers
   * @param heading for people; its unit is the title of the axis
   */
  record Group(String heading, String unit, List<Integer> fields) {}

  final List<Group> groups = new ArrayList<>();
  final int leftOut; // fields in no chart

  FieldGroups(List<Quantity> state) {
    Map<String, List<Integer>> units = new LinkedHashMap<>();
    for (int i = 0; i < state.size(); ++i) {
      units.computeIfAbsent(state.get(i).unit(), any -> new ArrayList<>()).add(i);
    }
    int room = MOST_CHARTS;
    int unitsLeft = units.size();
    for (Map.Entry<String, List<Integer>> unit : units.entrySet()) {
      --unitsLeft;
      room = add(state, unit.getKey(), unit.getValue(), room, Math.max(room - unitsLeft, Math.min(room, 1)));
    }
    leftOut = state.size() - groups.stream().mapToInt(group -> group.fields().size()).sum();
  }

  /** Adds at most `most` charts of the fields, and returns the room that remains. */
  private int add(List<Quantity> state, String unit, List<Integer> fields, int room, int most) {
    int charts = Math.min(most, (fields.size() + MOST_CURVES - 1) / MOST_CURVES);
    for (int i = 0; i < charts; ++i) {
      List<Integer> part = fields.subList(i * MOST_CURVES, Math.min(fields.size(), (i + 1) * MOST_CURVES));
      groups.add(new Group(headingOf(state, part, fields.size()), unit, List.copyOf(part)));
    }
    return room - charts;
  }

  private static String headingOf(List<Quantity> state, List<Integer> part, int ofUnit) {
    List<String> labels = part.stream().map(field -> state.get(field).label()).toList();
    String all = String.join(", ", labels);
    String names =
        all.length() <= LONGEST_HEADING ? all : labels.get(0) + " to " + labels.get(labels.size() - 1);
    String count = part.size() == ofUnit ? "" : " (" + part.size() + " of " + ofUnit + ")";
    return Text.capitalised(names) + count;
  }
}
