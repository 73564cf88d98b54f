package fresco.spy;

import java.util.Arrays;
import java.util.Locale;
import java.util.stream.Collectors;

/**
 * A quantity of a world: its name, such as "average_aoi", and its unit, which is empty if it has none.
 * Immutable.
 */
record Quantity(String name, String unit) {
  private static final int LONGEST_LABEL = 32;

  /** Reads "name" or "name [unit]". */
  static Quantity of(String line) {
    int bracket = line.lastIndexOf(" [");
    return bracket < 0 || !line.endsWith("]")
        ? new Quantity(line, "")
        : new Quantity(line.substring(0, bracket), line.substring(bracket + 2, line.length() - 1));
  }

  /** Returns the name for people: "average AoI", "energy margin" of energy_margin_j in joules. */
  String label() {
    String end = "_" + unit.toLowerCase(Locale.ROOT);
    return inWords(
        !unit.isEmpty() && name.endsWith(end) ? name.substring(0, name.length() - end.length()) : name);
  }

  String labelAndUnit() {
    return unit.isEmpty() ? label() : label() + ", " + unit;
  }

  /** Returns for example "12.346 slots"; "-" if the value is not finite. */
  String text(double value) {
    return Text.amount(value) + (Double.isFinite(value) && !unit.isEmpty() ? " " + unit : "");
  }

  /** Returns an identifier as words: "swung up" of swung_up. Cuts what is too long to be shown. */
  static String inWords(String identifier) {
    String words = Arrays.stream(identifier.split("_"))
                       .map(word -> word.equals("aoi") ? "AoI" : word)
                       .collect(Collectors.joining(" "));
    return words.length() <= LONGEST_LABEL ? words : words.substring(0, LONGEST_LABEL) + "..";
  }
}
