package fresco.spy;

import java.awt.Color;

/** Shows the numbers of a flight at the slot that is shown. Used on the event thread. */
final class FlightFacts {
  private final Facts facts =
      new Facts(1, "run", "flight", "order", "flown by", "slot", "over cell", "move", "collects",
          "mean AoI so far", "total AoI so far", "time margin", "energy margin", "on board", "outcome");

  Facts component() { return facts; }

  /** @param field null if it is not known yet */
  void show(Flight flight, int shown, Field field) {
    Step now = flight.steps.get(shown - 1);
    boolean over = flight.outcome != Flight.FLYING && shown == flight.steps.size();
    facts.set("run", String.format("%016x", flight.runId));
    facts.set("flight", flight.kind);
    facts.set("order", flight.live ? "-" : Long.toString(flight.number));
    facts.set("flown by", flight.source);
    facts.set("slot", field == null ? "" + now.slot() : now.slot() + " of " + field.slots());
    facts.set("over cell", placeOf(now, field));
    facts.set("move", over ? "-" : now.moveName());
    showCollected(now, field, over);
    facts.set("mean AoI so far", Text.orDash("%.3f slots", flight.averageAoi(shown, field)));
    facts.set("total AoI so far", flight.totalAoi(shown) + " slots");
    facts.set("time margin", now.timeMargin() + " slots", marginColour(now.timeMargin()));
    facts.set(
        "energy margin", Text.orDash("%,.0f J", now.energyMarginJ()), marginColour(now.energyMarginJ()));
    facts.set("on board", onBoard(now, field));
    Color colour = flight.outcome > 1 ? Palette.FAULT : Palette.INK;
    facts.set("outcome", over ? flight.outcomeName() : "flying", over ? colour : Palette.INK);
  }

  private static String placeOf(Step now, Field field) {
    String cell = "(" + now.column() + ", " + now.row() + ")";
    return field == null
        ? cell
        : String.format("%s: %s m east, %s m north", cell, Text.number(now.column() * field.cellM()),
            Text.number(now.row() * field.cellM()));
  }

  private void showCollected(Step now, Field field, boolean over) {
    if (over || now.scheduled() == 0) {
      facts.set("collects", over ? "-" : "nothing");
      return;
    }
    int sensor = now.scheduled() - 1;
    boolean known = field != null && sensor < field.sensors().size();
    boolean heard = !known || field.covers(now.column(), now.row(), sensor);
    String text = "sensor " + now.scheduled() + (heard ? "" : ", which is out of range");
    facts.set("collects", text, heard ? Palette.HIGHLIGHT : Palette.MUTED);
  }

  private static Color marginColour(double margin) { return margin < 0 ? Palette.FAULT : Palette.INK; }

  private static String onBoard(Step now, Field field) {
    if (!Double.isFinite(now.remainingEnergyJ())) {
      return "not told by transitions";
    }
    String energy = String.format("%,.0f J", now.remainingEnergyJ());
    return field == null ? energy : energy + String.format(" of %,.0f J", field.initialEnergyJ());
  }
}
