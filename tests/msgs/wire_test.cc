#include "msgs/wire.h"

#include <gtest/gtest.h>

#include <string>

#include "bus/authenticated_bus.h"
#include "core/random.h"
#include "msgs/order.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

using Bytes = std::vector<std::byte>;

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
  RandomStream stream(1, RandomPurpose::kTest, 78, 0);
  ForEachMessageType(
      [&]<class Message>(const Message&) { ExpectRoundTripAndRefusals(LargestMessage<Message>(stream)); });
}

TEST(Wire, EncodesAnOrderAsLcmsFormatSays) {
  Order order;
  order.index = 0x0102;
  order.kind = OrderKind::kEvaluate;
  order.epsilon = 0.5;
  order.search_width = 5;
  order.search_from = 6;
  order.seed = 7;
  order.current_version = 3;
  order.target_version = 4;
  const order_t wire = ToWire(order, 0x0A, 2);
  Bytes bytes(static_cast<size_t>(wire.getEncodedSize()));
  ASSERT_EQ(wire.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  // Big-endian, in the order of the fields, behind eight bytes of the type's fingerprint.
  const std::vector<int> expected = {0, 0, 0, 0,    0,    0, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0x0A, 0, 0,
                                     0, 2, 1, 0x3F, 0xE0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5, 0,    0, 0,
                                     6, 0, 0, 0,    0,    0, 0, 0, 7, 0, 0, 0, 3, 0, 0, 0,    4};
  ASSERT_EQ(bytes.size(), 8 + expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(static_cast<int>(bytes[8 + i]), expected[i]) << i;
  }
  Order decoded;
  EXPECT_TRUE(FromWire(wire, decoded));
  EXPECT_EQ(decoded, order);
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
