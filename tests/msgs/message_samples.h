// Messages of every type to test codecs with: of random content, and as large as they get.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/bytes.h"
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
void Randomise(RandomStream& stream, world_t& message);
void Randomise(RandomStream& stream, scenario_t& message);
void Randomise(RandomStream& stream, flight_t& message);
void Randomise(RandomStream& stream, probe_t& message);

/// A message with random content and every array and text as long as the codecs allow; transitions_t, whose
/// arrays share the frame, fills it.
void MakeLargest(RandomStream& stream, orders_t& message);
void MakeLargest(RandomStream& stream, weights_t& message);
void MakeLargest(RandomStream& stream, run_t& message);
void MakeLargest(RandomStream& stream, transitions_t& message);
void MakeLargest(RandomStream& stream, actor_status_t& message);
void MakeLargest(RandomStream& stream, learner_status_t& message);
void MakeLargest(RandomStream& stream, world_t& message);
void MakeLargest(RandomStream& stream, scenario_t& message);
void MakeLargest(RandomStream& stream, flight_t& message);
void MakeLargest(RandomStream& stream, probe_t& message);

template <class Message>
Message LargestMessage(RandomStream& stream) {
  Message message{};
  MakeLargest(stream, message);
  return message;
}

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
transitions_t TransitionsOf(RandomStream& stream, int transitions, int fields, int actions);
actor_status_t ActorStatusOf(RandomStream& stream, int held, int missing, int host_length);
learner_status_t LearnerStatusOf(RandomStream& stream, int waiting_for_length, int warning_length);
world_t WorldOf(RandomStream& stream, int world_length, int success_length, int entries_length);
scenario_t ScenarioOf(RandomStream& stream, int sensors, int cells);
probe_t ProbeOf(RandomStream& stream, int padding, int host_length);
flight_t FlightOf(RandomStream& stream, int sensors, int policy_length);

/// A configuration as a learner announces it, in parts of at most so many bytes.
std::vector<run_t> Announcement(const std::string& configuration, size_t part_bytes);

/// The result of an order whose episode takes random actions among those that are allowed.
OrderResult RandomResult(const World& world, const Order& order, RandomStream& stream);

/// Calls visit(Message{}) for every type of message that has a channel, in the order of MessageTypes.
template <class Visitor>
void ForEachMessageType(Visitor&& visit) {
  std::apply([&](const auto&... message) { (visit(message), ...); }, MessageTypes{});
}

template <class Message>
std::vector<std::byte> Encoded(const Message& message) {
  std::vector<std::byte> bytes;
  Encode(message, bytes);
  return bytes;
}

/// The encoding with the trailer that belongs behind it: what a hostile sender would send. A buffer of
/// exactly its size, so that a sanitizer sees every read beyond it.
inline std::vector<std::byte> WithTrailer(std::span<const std::byte> encoding) {
  std::vector<std::byte> bytes(encoding.begin(), encoding.end());
  const uint32_t crc = Crc32c(encoding);
  for (const int shift : {24, 16, 8, 0}) {
    bytes.push_back(static_cast<std::byte>(crc >> shift));
  }
  bytes.shrink_to_fit();
  return bytes;
}

}  // namespace fresco
