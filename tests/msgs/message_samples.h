// Messages of every type to test codecs with: of random content, and as large as they get.
#pragma once

#include <cstddef>
#include <vector>

#include "core/random.h"
#include "msgs/order.h"

namespace fresco {

/// A message with random content of the sizes that its counts allow.
void Randomise(RandomStream& stream, orders_t& message);
void Randomise(RandomStream& stream, weights_t& message);
void Randomise(RandomStream& stream, run_t& message);
void Randomise(RandomStream& stream, transitions_t& message);
void Randomise(RandomStream& stream, actor_status_t& message);
void Randomise(RandomStream& stream, learner_status_t& message);
void Randomise(RandomStream& stream, scenario_t& message);
void Randomise(RandomStream& stream, flight_t& message);

template <class Message>
Message RandomMessage(RandomStream& stream) {
  Message message{};
  Randomise(stream, message);
  return message;
}

/// Where every array has the given length.
orders_t OrdersOf(RandomStream& stream, int orders);
weights_t WeightsOf(RandomStream& stream, int values);
run_t RunOf(RandomStream& stream, int part_bytes);
transitions_t TransitionsOf(RandomStream& stream, int transitions, int sensors);
actor_status_t ActorStatusOf(RandomStream& stream, int held, int missing, int host_length);
learner_status_t LearnerStatusOf(RandomStream& stream, int waiting_for_length, int warning_length);
scenario_t ScenarioOf(RandomStream& stream, int sensors);
flight_t FlightOf(RandomStream& stream, int sensors, int policy_length);

/// The result of an order whose episode takes random actions among those that `mask` allows. It records
/// masks that allow everything.
OrderResult RandomResult(const World& world, int64_t order_index, MaskOptions mask, RandomStream& stream);

template <class Message>
std::vector<std::byte> Encoded(const Message& message) {
  std::vector<std::byte> bytes;
  Encode(message, bytes);
  return bytes;
}

}  // namespace fresco
