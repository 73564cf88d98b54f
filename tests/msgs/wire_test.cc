#include "msgs/wire.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "msgs/episode.h"
#include "msgs/order.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

constexpr uint32_t kThisTest = 1;

RandomStream TestStream(uint32_t index) {
  return {2026, RandomPurpose::kTest, kThisTest, index};
}

/// The bytes that hexadecimal digits, with spaces between fields, stand for.
std::vector<std::byte> FromHex(const std::string& text) {
  std::string digits;
  std::copy_if(text.begin(), text.end(), std::back_inserter(digits), [](char c) { return c != ' '; });
  std::vector<std::byte> bytes;
  for (size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

std::string FingerprintHex(int64_t hash) {
  std::string hex;
  for (int shift = 60; shift >= 0; shift -= 4) {
    hex += "0123456789abcdef"[(static_cast<uint64_t>(hash) >> shift) & 15];
  }
  return hex;
}

template <class Message>
class Wire : public testing::Test {};
using MessageTypes =
    testing::Types<run_t, orders_t, transitions_t, weights_t, actor_status_t, learner_status_t>;
TYPED_TEST_SUITE(Wire, MessageTypes);

TYPED_TEST(Wire, EncodesToTheSameBytesAfterDecoding) {
  for (uint32_t index = 0; index < 200; ++index) {
    RandomStream stream = TestStream(index);
    const std::vector<std::byte> bytes = Encoded(RandomMessage<TypeParam>(stream));
    TypeParam decoded{};
    ASSERT_TRUE(Decode(bytes, decoded));
    EXPECT_EQ(Encoded(decoded), bytes);
  }
}

TYPED_TEST(Wire, ReusesAMessageThatHeldALargerOne) {
  TypeParam decoded{};
  for (uint32_t index = 0; index < 50; ++index) {
    RandomStream stream = TestStream(index);
    const std::vector<std::byte> bytes = Encoded(RandomMessage<TypeParam>(stream));
    ASSERT_TRUE(Decode(bytes, decoded));
    EXPECT_EQ(Encoded(decoded), bytes);
  }
}

TYPED_TEST(Wire, StampsTheIdentity) {
  TypeParam message{};
  Stamp(message, {-7, 0xffffffffu}, 123);
  EXPECT_EQ(message.utime, 123);
  EXPECT_EQ(IdentityOf(message), (RunIdentity{-7, 0xffffffffu}));
}

TEST(WireFormat, OrdersHaveTheseBytes) {
  orders_t message{};
  Stamp(message, {-2, 0xdeadbeef}, 0x0102030405060708);
  message.order_count = 1;
  message.committed_orders = 5;
  const Order order{7, OrderKind::kEvaluate, 0.5, ~uint64_t{0}, 10, 2};
  message.orders = {ToWire(order, 0x1122334455667788, 3)};
  EXPECT_EQ(Encoded(message),
            FromHex(FingerprintHex(orders_t::getHash()) +
                    "0102030405060708 fffffffffffffffe 00000000deadbeef 00000001 0000000000000005"
                    "0000000000000007 1122334455667788 00000003 01 3fe0000000000000 ffffffffffffffff"
                    "0000000a 00000002"));
}

TEST(WireFormat, WeightsHaveTheseBytes) {
  weights_t message{};
  Stamp(message, {0x0a0b0c0d0e0f1011, 1}, 0);
  message.value_count = 2;
  message.version = 258;
  message.offset = 308;
  message.total_values = 310;
  message.crc32c = 0xcafebabe;
  message.values = {1.0f, -2.5f};
  EXPECT_EQ(Encoded(message), FromHex(FingerprintHex(weights_t::getHash()) +
                                      "0000000000000000 0a0b0c0d0e0f1011 0000000000000001 00000002"
                                      "00000102 00000134 00000136 00000000cafebabe 3f800000 c0200000"));
}

TEST(WireFormat, LargestMessagesLeaveRoomForTheTrailerInOneFrame) {
  RandomStream stream = TestStream(0);
  EXPECT_LE(Encoded(OrdersOf(stream, kMaximumOrdersPerMessage)).size(), kMaximumEncodedBytes);
  EXPECT_LE(Encoded(WeightsOf(stream, kValuesPerChunk)).size(), kMaximumEncodedBytes);
  EXPECT_LE(Encoded(RunOf(stream, kMaximumPartBytes)).size(), kMaximumEncodedBytes);
  EXPECT_LE(Encoded(LearnerStatusOf(stream, 160)).size(), kMaximumEncodedBytes);
  EXPECT_LE(Encoded(ActorStatusOf(stream, kMaximumHeldVersions, kMaximumMissingRanges, 64)).size(),
            kMaximumEncodedBytes);
  for (int sensors = 1; sensors <= kMaximumSensors; ++sensors) {
    const transitions_t message = TransitionsOf(stream, TransitionsPerMessage(sensors), sensors);
    const std::vector<std::byte> bytes = Encoded(message);
    EXPECT_LE(bytes.size(), kMaximumEncodedBytes) << sensors;
    transitions_t decoded{};
    EXPECT_TRUE(Decode(bytes, decoded)) << sensors;
  }
}

TEST(WireFormat, TransitionsFillTheirMessages) {
  for (int sensors = 1; sensors <= kMaximumSensors; ++sensors) {
    const transitions_t one_more = [&] {
      RandomStream stream = TestStream(1);
      return TransitionsOf(stream, TransitionsPerMessage(sensors) + 1, sensors);
    }();
    EXPECT_GT(one_more.getEncodedSize(), static_cast<int>(kMaximumEncodedBytes)) << sensors;
  }
}

TEST(WireOrder, RefusesValuesOutOfRange) {
  const order_t valid = ToWire({3, OrderKind::kTrain, 0.25, 9, 4, 5}, 1, 0);
  Order order;
  EXPECT_TRUE(FromWire(valid, order));
  EXPECT_EQ(order, (Order{3, OrderKind::kTrain, 0.25, 9, 4, 5}));
  const auto refused = [&](auto change) {
    order_t wire = valid;
    change(wire);
    return !FromWire(wire, order);
  };
  EXPECT_TRUE(refused([](order_t& wire) { wire.index = -1; }));
  EXPECT_TRUE(refused([](order_t& wire) { wire.index = int64_t{1} << 32; }));
  EXPECT_TRUE(refused([](order_t& wire) { wire.kind = 2; }));
  EXPECT_TRUE(refused([](order_t& wire) { wire.epsilon = 1.5; }));
  EXPECT_TRUE(refused([](order_t& wire) { wire.epsilon = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](order_t& wire) { wire.current_version = -1; }));
  EXPECT_TRUE(refused([](order_t& wire) { wire.target_version = -1; }));
  EXPECT_TRUE(refused([](order_t& wire) { wire.attempt = -1; }));
}

}  // namespace
}  // namespace fresco
