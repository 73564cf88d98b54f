#include "tests/msgs/message_samples.h"

#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>

#include "nn/mlp.h"

namespace fresco {
namespace {

template <class T>
void Fill(RandomStream& stream, T& value) {
  if constexpr (std::floating_point<T>) {
    value = static_cast<T>(2000 * stream.NextUniform() - 1000);
  } else {
    value = static_cast<T>((uint64_t{stream.NextWord()} << 32) | stream.NextWord());
  }
}

template <class T>
void Fill(RandomStream& stream, std::vector<T>& values, int count) {
  values.resize(static_cast<size_t>(count));
  for (T& value : values) {
    Fill(stream, value);
  }
}

/// Fills every number that is no array, and so the counts too.
template <class Message>
void FillNumbers(RandomStream& stream, Message& message) {
  ForEachField(message, [&]<class T>(const char*, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      Fill(stream, const_cast<T&>(value));
    }
  });
}

template <class Message>
Message WithNumbers(RandomStream& stream) {
  Message message{};
  FillNumbers(stream, message);
  return message;
}

std::string RandomText(RandomStream& stream, int length) {
  std::string text;
  for (int i = 0; i < length; ++i) {
    text += static_cast<char>('a' + stream.NextBelow(26));
  }
  return text;
}

int Below(RandomStream& stream, int bound) {
  return static_cast<int>(stream.NextBelow(static_cast<uint32_t>(bound)));
}

std::vector<chunk_range_t> RangesOf(RandomStream& stream, int count) {
  std::vector<chunk_range_t> ranges(static_cast<size_t>(count));
  for (chunk_range_t& range : ranges) {
    FillNumbers(stream, range);
  }
  return ranges;
}

}  // namespace

orders_t OrdersOf(RandomStream& stream, int orders) {
  auto message = WithNumbers<orders_t>(stream);
  message.order_count = orders;
  message.orders.resize(static_cast<size_t>(orders));
  for (order_t& order : message.orders) {
    FillNumbers(stream, order);
  }
  return message;
}

weights_t WeightsOf(RandomStream& stream, int values) {
  auto message = WithNumbers<weights_t>(stream);
  message.value_count = values;
  Fill(stream, message.values, values);
  return message;
}

run_t RunOf(RandomStream& stream, int part_bytes) {
  auto message = WithNumbers<run_t>(stream);
  message.part_size = part_bytes;
  Fill(stream, message.part, part_bytes);
  return message;
}

std::vector<run_t> Announcement(const std::string& configuration, size_t part_bytes) {
  std::vector<run_t> parts((configuration.size() + part_bytes - 1) / part_bytes);
  for (size_t i = 0; i < parts.size(); ++i) {
    const std::string part = configuration.substr(i * part_bytes, part_bytes);
    parts[i].part_index = static_cast<int32_t>(i);
    parts[i].part_count = static_cast<int32_t>(parts.size());
    parts[i].part_size = static_cast<int32_t>(part.size());
    parts[i].part.assign(part.begin(), part.end());
    parts[i].protocol_version = kProtocolVersion;
    parts[i].arithmetic_fingerprint = ArithmeticFingerprint();
  }
  return parts;
}

transitions_t TransitionsOf(RandomStream& stream, int transitions, int fields, int actions) {
  auto message = WithNumbers<transitions_t>(stream);
  message.transition_count = transitions;
  message.state_count = transitions + 1;
  message.field_count = fields;
  message.mask_size = MaskSize(actions);
  message.state.resize(static_cast<size_t>(message.state_count));
  for (auto& state : message.state) {
    Fill(stream, state, fields);
  }
  Fill(stream, message.action, transitions);
  Fill(stream, message.reward, transitions);
  Fill(stream, message.td_error, transitions);
  message.next_mask.resize(static_cast<size_t>(transitions));
  for (auto& mask : message.next_mask) {
    Fill(stream, mask, message.mask_size);
  }
  return message;
}

actor_status_t ActorStatusOf(RandomStream& stream, int held, int missing, int host_length) {
  auto message = WithNumbers<actor_status_t>(stream);
  message.host = RandomText(stream, host_length);
  message.held_count = held;
  message.missing_count = missing;
  message.held = RangesOf(stream, held);
  message.missing = RangesOf(stream, missing);
  return message;
}

learner_status_t LearnerStatusOf(RandomStream& stream, int waiting_for_length, int warning_length) {
  auto message = WithNumbers<learner_status_t>(stream);
  message.waiting_for = RandomText(stream, waiting_for_length);
  message.warning = RandomText(stream, warning_length);
  return message;
}

world_t WorldOf(RandomStream& stream, int world_length, int success_length, int entries_length) {
  auto message = WithNumbers<world_t>(stream);
  message.world = RandomText(stream, world_length);
  message.success = RandomText(stream, success_length);
  message.entries = RandomText(stream, entries_length);
  return message;
}

scenario_t ScenarioOf(RandomStream& stream, int sensors, int cells) {
  auto message = WithNumbers<scenario_t>(stream);
  message.sensor_count = sensors;
  for (auto* values : {&message.x_m, &message.y_m, &message.weight}) {
    Fill(stream, *values, sensors);
  }
  message.cell_count = cells;
  Fill(stream, message.cell_kind, cells);
  return message;
}

flight_t FlightOf(RandomStream& stream, int sensors, int policy_length) {
  auto message = WithNumbers<flight_t>(stream);
  message.policy = RandomText(stream, policy_length);
  message.sensor_count = sensors;
  Fill(stream, message.aoi, sensors);
  return message;
}

probe_t ProbeOf(RandomStream& stream, int padding, int host_length) {
  auto message = WithNumbers<probe_t>(stream);
  message.host = RandomText(stream, host_length);
  message.padding_count = padding;
  Fill(stream, message.padding, padding);
  return message;
}

void Randomise(RandomStream& stream, orders_t& message) {
  message = OrdersOf(stream, Below(stream, kMaximumOrdersPerMessage + 1));
}
void Randomise(RandomStream& stream, weights_t& message) {
  message = WeightsOf(stream, Below(stream, kValuesPerChunk + 1));
}
void Randomise(RandomStream& stream, run_t& message) {
  message = RunOf(stream, Below(stream, kMaximumPartBytes + 1));
}
void Randomise(RandomStream& stream, transitions_t& message) {
  message = TransitionsOf(stream, 1 + Below(stream, 9), 1 + Below(stream, 12), 1 + Below(stream, 100));
}
void Randomise(RandomStream& stream, actor_status_t& message) {
  message = ActorStatusOf(stream, Below(stream, 33), Below(stream, 33), Below(stream, 65));
}
void Randomise(RandomStream& stream, learner_status_t& message) {
  message = LearnerStatusOf(stream, Below(stream, 241), Below(stream, 241));
}
void Randomise(RandomStream& stream, world_t& message) {
  message = WorldOf(stream, Below(stream, world_t::MAXIMUM_WORLD_BYTES + 1),
                    Below(stream, world_t::MAXIMUM_SUCCESS_BYTES + 1),
                    Below(stream, world_t::MAXIMUM_ENTRIES_BYTES + 1));
}
void Randomise(RandomStream& stream, scenario_t& message) {
  message = ScenarioOf(stream, Below(stream, kMaximumSensorsPerScenario + 1),
                       Below(stream, kMaximumCellsPerScenario + 1));
}
void Randomise(RandomStream& stream, flight_t& message) {
  message = FlightOf(stream, Below(stream, flight_t::MAXIMUM_SENSOR_COUNT + 1),
                     Below(stream, kMaximumPolicyBytes + 1));
}

void Randomise(RandomStream& stream, probe_t& message) {
  message = ProbeOf(stream, Below(stream, probe_t::MAXIMUM_PADDING_COUNT + 1),
                    Below(stream, probe_t::MAXIMUM_HOST_BYTES + 1));
}

OrderResult RandomResult(const World& world, const Order& order, RandomStream& stream) {
  EpisodeRecorder recorder(world, order.seed);
  OrderResult result{order.index, order.seed, 0, 0, {}, {}};
  while (!recorder.ended()) {
    uint32_t action = 0;
    do {
      action = stream.NextBelow(static_cast<uint32_t>(world.actions()));
    } while (recorder.mask()[action] == 0);
    recorder.Step(static_cast<int>(action));
    result.td_errors.push_back(static_cast<float>(stream.NextUniform()));
  }
  result.episode = recorder.Release();
  return result;
}

void MakeLargest(RandomStream& stream, orders_t& message) {
  message = OrdersOf(stream, kMaximumOrdersPerMessage);
}
void MakeLargest(RandomStream& stream, weights_t& message) {
  message = WeightsOf(stream, kValuesPerChunk);
}
void MakeLargest(RandomStream& stream, run_t& message) {
  message = RunOf(stream, kMaximumPartBytes);
}
void MakeLargest(RandomStream& stream, transitions_t& message) {
  constexpr int kFields = 7;
  constexpr int kActions = 20;
  int transitions = 1;
  while (static_cast<size_t>(TransitionsOf(stream, transitions + 1, kFields, kActions).getEncodedSize()) <=
         kMaximumEncodedBytes) {
    ++transitions;
  }
  message = TransitionsOf(stream, transitions, kFields, kActions);
}
void MakeLargest(RandomStream& stream, actor_status_t& message) {
  message = ActorStatusOf(stream, kMaximumHeldVersions, kMaximumMissingRanges, kMaximumHostBytes);
}
void MakeLargest(RandomStream& stream, learner_status_t& message) {
  message = LearnerStatusOf(stream, kMaximumWaitingForBytes, kMaximumWarningBytes);
}
void MakeLargest(RandomStream& stream, world_t& message) {
  message = WorldOf(stream, world_t::MAXIMUM_WORLD_BYTES, world_t::MAXIMUM_SUCCESS_BYTES,
                    world_t::MAXIMUM_ENTRIES_BYTES);
}
void MakeLargest(RandomStream& stream, scenario_t& message) {
  message = ScenarioOf(stream, kMaximumSensorsPerScenario, kMaximumCellsPerScenario);
}
void MakeLargest(RandomStream& stream, flight_t& message) {
  message = FlightOf(stream, flight_t::MAXIMUM_SENSOR_COUNT, kMaximumPolicyBytes);
}
void MakeLargest(RandomStream& stream, probe_t& message) {
  message = ProbeOf(stream, probe_t::MAXIMUM_PADDING_COUNT, probe_t::MAXIMUM_HOST_BYTES);
}

}  // namespace fresco
