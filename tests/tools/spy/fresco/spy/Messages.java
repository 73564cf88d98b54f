package fresco.spy;

import fresco.flight_t;
import fresco.scenario_t;
import fresco.transitions_t;
import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.util.Arrays;
import java.util.zip.CRC32C;
import lcm.lcm.LCMEncodable;

/** Messages as they stand on the wire, for the tests of what the windows make of them. */
final class Messages {
  private Messages() {}

  /** LCM's encoding, the CRC behind it, and so many bytes of a tag. */
  static byte[] encoded(LCMEncodable message, int tagBytes) throws IOException {
    ByteArrayOutputStream bytes = new ByteArrayOutputStream();
    message.encode(new DataOutputStream(bytes));
    return withTrailer(bytes.toByteArray(), tagBytes);
  }

  static byte[] withTrailer(byte[] encoding, int tagBytes) {
    CRC32C crc = new CRC32C();
    crc.update(encoding);
    byte[] message = Arrays.copyOf(encoding, encoding.length + 4 + tagBytes);
    ByteBuffer.wrap(message).putInt(encoding.length, (int) crc.getValue());
    return message;
  }

  /** Slot `slot` of a flight over `sensors` sensors, all of age `slot`. */
  static flight_t flight(long run, int flight, int slot, int sensors) {
    flight_t message = new flight_t();
    message.run_id = run;
    message.flight = flight;
    message.slot = slot;
    message.slots = 70;
    message.policy = "aoi";
    message.sensor_count = sensors;
    message.aoi = ages(slot, sensors);
    return message;
  }

  /** A field of `total` sensors, of which this message has `count` from `first` on. Sensor n weighs n + 1. */
  static scenario_t scenario(long run, int first, int count, int total) {
    scenario_t message = new scenario_t();
    message.run_id = run;
    message.sensor_count = count;
    message.first_sensor = first;
    message.total_sensors = total;
    message.columns = message.rows = 20;
    message.cell_m = 25;
    message.slots = 70;
    message.slot_s = 1;
    message.coverage_radius_m = 100;
    message.initial_energy_j = 22000;
    message.x_m = new double[count];
    message.y_m = new double[count];
    message.weight = new double[count];
    for (int i = 0; i < count; ++i) {
      message.weight[i] = first + i + 1;
    }
    return message;
  }

  /**
   * Transitions `first` .. of an episode with two sensors; ages are slot numbers, columns transition
   * numbers.
   */
  static transitions_t transitions(long run, long order, int first, int count, int outcome) {
    transitions_t message = new transitions_t();
    message.run_id = run;
    message.order_index = order;
    message.actor_id = 7;
    message.first_transition = first;
    message.outcome = (byte) outcome;
    message.transition_count = count;
    message.state_count = count + 1;
    message.sensor_count = 2;
    message.mask_size = 2;
    message.column = ages(first, count + 1);
    message.row = message.time_margin = new short[count + 1];
    message.energy_margin_j = new float[count + 1];
    message.aoi = new short[count + 1][];
    for (int i = 0; i <= count; ++i) {
      message.column[i] = (short) (first + i);
      message.aoi[i] = ages(first + i + 1, 2);
    }
    message.action = new short[count];
    Arrays.fill(message.action, (short) (2 * 3 + 1)); // east, sensor 1
    message.reward = message.td_error = new float[count];
    message.next_mask = new byte[count][2];
    return message;
  }

  private static short[] ages(int age, int sensors) {
    short[] ages = new short[sensors];
    Arrays.fill(ages, (short) age);
    return ages;
  }
}
