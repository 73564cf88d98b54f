#include "msgs/wire.h"

#include <gtest/gtest.h>

#include <string>

#include "bus/authenticated_bus.h"
#include "core/bytes.h"
#include "core/random.h"
#include "msgs/order.h"
#include "msgs/weights_codec.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

using Bytes = std::vector<std::byte>;

/// The largest of every type that the codecs allow, but for transitions_t, which is filled to the frame.
orders_t FullOrders() {
  orders_t message{};
  message.order_count = kMaximumOrdersPerMessage;
  message.orders.resize(kMaximumOrdersPerMessage);
  return message;
}

run_t FullRun() {
  run_t message{};
  message.part_size = kMaximumPartBytes;
  message.part.assign(kMaximumPartBytes, 'x');
  return message;
}

weights_t FullWeights() {
  const std::vector<float> values(2 * kValuesPerChunk, 1.5f);
  return WeightsChunk(values, 1, 3, 1);
}

actor_status_t FullActorStatus() {
  actor_status_t message{};
  message.host = std::string(kMaximumHostBytes, 'h');
  message.held_count = kMaximumHeldVersions;
  message.held.resize(kMaximumHeldVersions);
  message.missing_count = kMaximumMissingRanges;
  message.missing.resize(kMaximumMissingRanges);
  return message;
}

learner_status_t FullLearnerStatus() {
  learner_status_t message{};
  message.waiting_for = std::string(kMaximumWaitingForBytes, 'w');
  message.warning = std::string(kMaximumWarningBytes, 'w');
  return message;
}

scenario_t FullScenario() {
  RandomStream stream(1, RandomPurpose::kTest, 78, 0);
  return ScenarioOf(stream, kMaximumSensorsPerScenario);
}

flight_t FullFlight() {
  RandomStream stream(1, RandomPurpose::kTest, 79, 0);
  return FlightOf(stream, flight_t::MAXIMUM_SENSOR_COUNT, kMaximumPolicyBytes);
}

template <class Message>
void ExpectRoundTripAndRefusals(const Message& message) {
  const Bytes bytes = Encoded(message);
  EXPECT_LE(bytes.size(), kMaximumMessageBytes);
  Message decoded{};
  ASSERT_TRUE(Decode(bytes, decoded));
  EXPECT_EQ(Encoded(decoded), bytes);
  for (size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(Decode(std::span(bytes).first(size), decoded)) << size;
  }
  for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    Bytes flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    EXPECT_FALSE(Decode(flipped, decoded)) << bit;
  }
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(Decode(longer, decoded));
  longer.resize(kMaximumMessageBytes + 1);
  EXPECT_FALSE(Decode(longer, decoded));
}

TEST(Wire, CarriesTheLargestMessagesAndRefusesEveryTruncationAndFlippedBit) {
  ExpectRoundTripAndRefusals(FullOrders());
  ExpectRoundTripAndRefusals(FullRun());
  ExpectRoundTripAndRefusals(FullWeights());
  ExpectRoundTripAndRefusals(FullActorStatus());
  ExpectRoundTripAndRefusals(FullLearnerStatus());
  ExpectRoundTripAndRefusals(FullScenario());
  ExpectRoundTripAndRefusals(FullFlight());
}

/// Replaces the CRC by the right one: what a hostile sender would do.
Bytes WithRightCrc(Bytes encoding) {
  const uint32_t crc = Crc32c(encoding);
  for (const int shift : {24, 16, 8, 0}) {
    encoding.push_back(static_cast<std::byte>(crc >> shift));
  }
  return encoding;
}

TEST(Wire, RefusesAbsurdCountsBeforeAnythingIsAllocated) {
  constexpr size_t kCountsBegin = 8 + 3 * 8;  // behind fingerprint, utime, run_id, config_hash
  const Bytes bytes = Encoded(FullActorStatus());
  for (const size_t offset : {kCountsBegin, kCountsBegin + 4}) {
    for (const uint32_t count :
         {0xFFFFFFFFu, 500'000'000u, static_cast<uint32_t>(kMaximumHeldVersions) + 1, 0x80000000u}) {
      Bytes changed(bytes.begin(), bytes.end() - 4);
      for (size_t i = 0; i < 4; ++i) {
        changed[offset + i] = static_cast<std::byte>(count >> (24 - 8 * i));
      }
      actor_status_t decoded{};
      EXPECT_FALSE(Decode(WithRightCrc(changed), decoded));
    }
  }
}

TEST(Wire, SurvivesRandomBytesWithARightCrc) {
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  const Bytes valid = Encoded(FullActorStatus());
  for (int trial = 0; trial < 20000; ++trial) {
    Bytes bytes(valid.begin(), valid.end() - 4);
    for (uint32_t i = stream.NextBelow(8); i > 0; --i) {  // behind the type's fingerprint
      bytes[8 + stream.NextBelow(static_cast<uint32_t>(bytes.size()) - 8)] =
          static_cast<std::byte>(stream.NextWord());
    }
    bytes.resize(bytes.size() - stream.NextBelow(3));
    actor_status_t decoded{};
    Decode(WithRightCrc(bytes), decoded);  // true or false, but nothing worse
  }
}

TEST(Wire, RefusesAMessageOfAnotherType) {
  run_t decoded{};
  EXPECT_FALSE(Decode(Encoded(FullOrders()), decoded));
}

TEST(Wire, EncodesAnOrderAsLcmsFormatSays) {
  Order order;
  order.index = 0x0102;
  order.kind = OrderKind::kEvaluate;
  order.epsilon = 0.5;
  order.seed = 7;
  order.current_version = 3;
  order.target_version = 4;
  const order_t wire = ToWire(order, 0x0A, 2);
  Bytes bytes(static_cast<size_t>(wire.getEncodedSize()));
  ASSERT_EQ(wire.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  // Big-endian, in the order of the fields, behind eight bytes of the type's fingerprint.
  const std::vector<int> expected = {0,    0, 0, 0, 0, 0, 1,    2,    0, 0, 0, 0, 0, 0, 0,
                                     0x0A, 0, 0, 0, 2, 1, 0x3F, 0xE0, 0, 0, 0, 0, 0, 0, 0,
                                     0,    0, 0, 0, 0, 0, 7,    0,    0, 0, 3, 0, 0, 0, 4};
  ASSERT_EQ(bytes.size(), 8 + expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(static_cast<int>(bytes[8 + i]), expected[i]) << i;
  }
  Order decoded;
  EXPECT_TRUE(FromWire(wire, decoded));
  EXPECT_EQ(decoded, order);
}

TEST(Weights, ChunksCoverTheParametersExactly) {
  for (const int64_t count : {1, kValuesPerChunk, kValuesPerChunk + 1, 58196}) {
    std::vector<float> values(static_cast<size_t>(count));
    for (size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<float>(i);
    }
    std::vector<float> joined;
    for (int chunk = 0; chunk < ChunkCount(count); ++chunk) {
      const weights_t message = WeightsChunk(values, 5, 9, chunk);
      EXPECT_EQ(ChunkIndex(message, count), chunk);
      EXPECT_EQ(ChunkIndex(message, count + kValuesPerChunk), -1);
      joined.insert(joined.end(), message.values.begin(), message.values.end());
    }
    EXPECT_EQ(joined, values);
  }
}

TEST(Wire, IsReadByLcmsOwnDecoderWhateverStandsBehindTheMessage) {
  RandomStream stream(3, RandomPurpose::kTest, 77, 0);
  const learner_status_t message = RandomMessage<learner_status_t>(stream);
  std::vector<std::byte> bytes = Encoded(message);
  bytes.resize(bytes.size() + kAuthenticationTagBytes, std::byte{0xa5});
  learner_status_t decoded{};
  EXPECT_EQ(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())), message.getEncodedSize());
  EXPECT_EQ(decoded.waiting_for, message.waiting_for);
  EXPECT_EQ(decoded.updates, message.updates);
}

}  // namespace
}  // namespace fresco
