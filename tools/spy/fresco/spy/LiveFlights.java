package fresco.spy;

import fresco.flight_t;

/** Joins flight_t messages to the flight that `fresco fly` shows. Used on the event thread. */
final class LiveFlights {
  private Flight flight;

  /** Adds the message's slot to its flight and returns that; null if the message is not usable. */
  Flight add(flight_t message) {
    if (message.sensor_count < 1 || message.slot < 1 || message.slot > Fields.MAXIMUM_SLOTS) {
      return null;
    }
    if (flight == null || !continues(message)) {
      String kind = "policy " + message.policy;
      flight = new Flight(
          message.run_id, message.flight, kind, "fresco fly, flight " + (message.flight + 1L), true);
    }
    flight.steps.add(stepOf(message));
    flight.outcome = message.outcome;
    return flight;
  }

  private boolean continues(flight_t message) {
    Step last = flight.steps.get(flight.steps.size() - 1);
    return message.run_id == flight.runId && message.flight == flight.number && message.slot > last.slot()
        && message.sensor_count == last.aoi().length;
  }

  private static Step stepOf(flight_t message) {
    return new Step(message.slot, message.column, message.row, message.aoi, message.move, message.scheduled,
        message.time_margin, message.energy_margin_j, message.remaining_energy_j);
  }
}
