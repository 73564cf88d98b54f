package fresco.spy;

import fresco.actor_status_t;
import fresco.chunk_range_t;
import fresco.flight_t;
import fresco.learner_status_t;
import fresco.order_t;
import fresco.orders_t;
import fresco.scenario_t;
import fresco.transitions_t;

/** The messages that the windows draw, with the limits of msgs/wire.h. */
final class MessageTypes {
  static final int MAXIMUM_SENSORS = 250;
  static final int MAXIMUM_SLOTS = 10_000;

  static final MessageType<scenario_t> SCENARIO = new MessageType<>(scenario_t::new, emptyScenario(), 0, 48);
  static final MessageType<flight_t> FLIGHT =
      new MessageType<>(flight_t::new, emptyFlight(), 1, MAXIMUM_SENSORS);
  static final MessageType<transitions_t> TRANSITIONS =
      new MessageType<>(transitions_t::new, emptyTransitions(), 0, 128, 129, MAXIMUM_SENSORS, 157);
  static final MessageType<orders_t> ORDERS = new MessageType<>(orders_t::new, emptyOrders(), 0, 27);
  static final MessageType<actor_status_t> ACTOR_STATUS =
      new MessageType<>(actor_status_t::new, emptyActorStatus(), 1, 32, 32);
  static final MessageType<learner_status_t> LEARNER_STATUS =
      new MessageType<>(learner_status_t::new, emptyLearnerStatus(), 2);

  private MessageTypes() {}

  private static scenario_t emptyScenario() {
    scenario_t message = new scenario_t();
    message.x_m = message.y_m = message.weight = new double[0];
    return message;
  }

  private static flight_t emptyFlight() {
    flight_t message = new flight_t();
    message.policy = "";
    message.aoi = new short[0];
    return message;
  }

  private static transitions_t emptyTransitions() {
    transitions_t message = new transitions_t();
    message.column = message.row = message.time_margin = message.action = new short[0];
    message.energy_margin_j = message.reward = message.td_error = new float[0];
    message.aoi = new short[0][0];
    message.next_mask = new byte[0][0];
    return message;
  }

  private static orders_t emptyOrders() {
    orders_t message = new orders_t();
    message.orders = new order_t[0];
    return message;
  }

  private static actor_status_t emptyActorStatus() {
    actor_status_t message = new actor_status_t();
    message.host = "";
    message.held = message.missing = new chunk_range_t[0];
    return message;
  }

  private static learner_status_t emptyLearnerStatus() {
    learner_status_t message = new learner_status_t();
    message.waiting_for = message.warning = "";
    return message;
  }
}
