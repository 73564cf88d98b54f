package fresco.spy;

import fresco.flight_t;
import fresco.scenario_t;
import fresco.transitions_t;
import fresco.world_t;
import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.util.Arrays;
import java.util.List;
import java.util.stream.Collectors;
import java.util.stream.IntStream;
import java.util.stream.Stream;
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
    message.cell_kind = new byte[0];
    for (int i = 0; i < count; ++i) {
      message.weight[i] = first + i + 1;
    }
    return message;
  }

  /** Adds cells of a map of `total` cells to a message: these kinds, from `first` on. */
  static scenario_t withCells(scenario_t message, int first, String kinds, int total) {
    message.first_cell = first;
    message.cell_count = kinds.length();
    message.total_cells = total;
    message.cell_kind = kinds.getBytes(java.nio.charset.StandardCharsets.US_ASCII);
    return message;
  }

  /** The names of the UAV's world with two sensors. */
  static WorldNames uav() {
    Worlds worlds = new Worlds();
    worlds.add(world(1, "uav",
        List.of("column [cells]", "row [cells]", "time_margin [slots]", "energy_margin_j [J]",
            "aoi_1 [slots]", "aoi_2 [slots]"),
        15, 10_000));
    return worlds.of(1);
  }

  /** The names of a world in one message: actions "action 0" and so on, the figure average_aoi. */
  static world_t world(long run, String kind, List<String> state, int actions, int longestEpisode) {
    world_t message = new world_t();
    message.run_id = run;
    message.world = kind;
    message.success = "arrived";
    message.state_size = state.size();
    message.action_count = actions;
    message.figure_count = 1;
    message.entry_count = state.size() + actions + 1;
    message.longest_episode = longestEpisode;
    message.less_is_better = 1;
    message.entries = Stream
                          .of(state.stream(), IntStream.range(0, actions).mapToObj(i -> "action " + i),
                              Stream.of("average_aoi [slots]"))
                          .flatMap(lines -> lines)
                          .map(line -> line + "\n")
                          .collect(Collectors.joining());
    return message;
  }

  /** Lines `first` .. of a message. */
  static world_t part(world_t whole, int first, int count) {
    world_t part = new world_t();
    part.run_id = whole.run_id;
    part.world = whole.world;
    part.success = whole.success;
    part.state_size = whole.state_size;
    part.action_count = whole.action_count;
    part.figure_count = whole.figure_count;
    part.longest_episode = whole.longest_episode;
    part.less_is_better = whole.less_is_better;
    part.first_entry = first;
    part.entry_count = count;
    part.entries =
        whole.entries.lines().skip(first).limit(count).map(line -> line + "\n").collect(Collectors.joining());
    return part;
  }

  /**
   * Transitions `first` .. of an episode in the UAV's world with two sensors; ages are slot numbers, columns
   * transition numbers, each reward is 2.
   */
  static transitions_t transitions(long run, long order, int first, int count, int ending) {
    transitions_t message = new transitions_t();
    message.run_id = run;
    message.order_index = order;
    message.actor_id = 7;
    message.seed = 5;
    message.first_transition = first;
    message.ending = (byte) ending;
    message.transition_count = count;
    message.state_count = count + 1;
    message.field_count = 6;
    message.mask_size = 2;
    message.state = new float[count + 1][];
    for (int i = 0; i <= count; ++i) {
      int slot = first + i + 1;
      message.state[i] = new float[] {first + i, 3, 4, 50, slot, slot};
    }
    message.action = new short[count];
    Arrays.fill(message.action, (short) (2 * 3 + 1)); // east, sensor 1
    message.reward = new float[count];
    Arrays.fill(message.reward, 2);
    message.td_error = new float[count];
    message.next_mask = new byte[count][2];
    return message;
  }

  /** Some fields of a message that has all. */
  static transitions_t fields(transitions_t message, int first, int count) {
    message.first_field = first;
    message.field_count = count;
    for (int i = 0; i < message.state_count; ++i) {
      message.state[i] = Arrays.copyOfRange(message.state[i], first, first + count);
    }
    return message;
  }

  private static short[] ages(int age, int sensors) {
    short[] ages = new short[sensors];
    Arrays.fill(ages, (short) age);
    return ages;
  }
}
