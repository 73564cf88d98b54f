// What arrives from the network may be anything.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "msgs/wire.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

constexpr uint32_t kThisTest = 2;
constexpr size_t kFirstCount = 8 + 3 * 8;  // after fingerprint, utime, run_id, config_hash

RandomStream TestStream(uint32_t index) {
  return {2026, RandomPurpose::kTest, kThisTest, index};
}

void PutInt32(std::vector<std::byte>& bytes, size_t offset, int32_t value) {
  for (size_t i = 0; i < 4; ++i) {
    bytes.at(offset + i) = static_cast<std::byte>(static_cast<uint32_t>(value) >> (24 - 8 * i));
  }
}

std::vector<std::byte> RandomBytes(RandomStream& stream, size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes) {
    byte = static_cast<std::byte>(stream.NextWord());
  }
  return bytes;
}

/// Decodes a copy of exactly the message's size, so that a sanitizer sees every read beyond it.
template <class Message>
bool Decodes(std::span<const std::byte> bytes) {
  const std::vector<std::byte> exact(bytes.begin(), bytes.end());
  Message message{};
  return Decode(exact, message);
}

std::vector<std::byte> WithoutTrailerOf(std::vector<std::byte> message) {
  message.resize(message.size() - kTrailerBytes);
  return message;
}

template <class Message>
class HostileWire : public testing::Test {
 protected:
  static std::vector<std::byte> Valid(uint32_t index) {
    RandomStream stream = TestStream(index);
    return Encoded(RandomMessage<Message>(stream));
  }
};

template <class Tuple>
struct TypesOf;
template <class... Message>
struct TypesOf<std::tuple<Message...>> {
  using Types = testing::Types<Message...>;
};
TYPED_TEST_SUITE(HostileWire, TypesOf<MessageTypes>::Types);

TYPED_TEST(HostileWire, SurvivesEverySingleBitFlipBehindARightCrc) {
  for (uint32_t index = 0; index < 3; ++index) {
    std::vector<std::byte> encoding = WithoutTrailerOf(this->Valid(index));
    for (size_t bit = 0; bit < 8 * encoding.size(); ++bit) {
      const std::byte flipped{static_cast<unsigned char>(1u << bit % 8)};
      encoding[bit / 8] ^= flipped;
      TypeParam message{};
      if (const std::vector<std::byte> bytes = WithTrailer(encoding); Decode(bytes, message)) {
        ASSERT_EQ(Encoded(message), bytes) << "bit " << bit;
        ASSERT_GE(bit, 64u) << "the fingerprint is not looked at";
      }
      encoding[bit / 8] ^= flipped;
    }
  }
}

TYPED_TEST(HostileWire, RejectsAbsurdCounts) {
  const auto maxima = Description<TypeParam>::kCountMaxima;
  for (size_t count = 0; count < maxima.size(); ++count) {
    const int32_t maximum = maxima[count];
    for (const int32_t absurd : {-1, 500'000'000, maximum + 1, std::numeric_limits<int32_t>::min(),
                                 std::numeric_limits<int32_t>::max()}) {
      std::vector<std::byte> encoding = WithoutTrailerOf(this->Valid(1));
      PutInt32(encoding, kFirstCount + 4 * count, absurd);
      TypeParam message{};
      EXPECT_FALSE(CountsAreAllowed(encoding, maxima)) << "count " << count << ": " << absurd;
      EXPECT_FALSE(Decode(WithTrailer(encoding), message)) << "count " << count << ": " << absurd;
      EXPECT_EQ(message.utime, 0) << "it was decoded";
    }
  }
}

TYPED_TEST(HostileWire, RejectsTrailingBytes) {
  std::vector<std::byte> bytes = this->Valid(2);
  while (bytes.size() < kMaximumMessageBytes) {
    bytes.push_back(std::byte{0});
    ASSERT_FALSE(Decodes<TypeParam>(bytes)) << bytes.size();
  }
}

TYPED_TEST(HostileWire, SurvivesRandomBytes) {
  const std::vector<std::byte> valid = this->Valid(4);
  for (uint32_t index = 0; index < 1000; ++index) {
    RandomStream stream = TestStream(index);
    std::vector<std::byte> bytes = RandomBytes(stream, stream.NextBelow(kMaximumMessageBytes + 1));
    EXPECT_FALSE(Decodes<TypeParam>(bytes));
    std::copy_n(valid.begin(), std::min(bytes.size(), kFirstCount), bytes.begin());
    for (size_t offset = kFirstCount; offset + 4 <= std::min(bytes.size(), kFirstCount + 16); offset += 4) {
      PutInt32(bytes, offset, static_cast<int32_t>(stream.NextBelow(9)));
    }
    TypeParam message{};
    if (const std::vector<std::byte> sent = WithTrailer(bytes); Decode(sent, message)) {
      EXPECT_EQ(Encoded(message), sent);
    }
  }
}

TYPED_TEST(HostileWire, SurvivesSomeRandomBytesInAValidMessage) {
  const std::vector<std::byte> valid = WithoutTrailerOf(this->Valid(4));
  for (uint32_t index = 0; index < 1000; ++index) {
    RandomStream stream = TestStream(index);
    std::vector<std::byte> bytes = valid;
    for (uint32_t i = stream.NextBelow(8); i > 0; --i) {  // behind the type's fingerprint
      bytes[8 + stream.NextBelow(static_cast<uint32_t>(bytes.size()) - 8)] =
          static_cast<std::byte>(stream.NextWord());
    }
    bytes.resize(bytes.size() - stream.NextBelow(3));
    TypeParam message{};
    if (const std::vector<std::byte> sent = WithTrailer(bytes); Decode(sent, message)) {
      EXPECT_EQ(Encoded(message), sent);
    }
  }
}

TYPED_TEST(HostileWire, RejectsEveryOtherType) {
  RandomStream stream = TestStream(5);
  ForEachMessageType([&]<class Message>(const Message&) {
    const bool same = std::is_same_v<Message, TypeParam>;
    EXPECT_EQ(Decodes<TypeParam>(Encoded(RandomMessage<Message>(stream))), same) << Message::getTypeName();
  });
}

template <class Message>
void ExpectStringsOfAbsurdLengthRejected(Message message, std::string Message::*text) {
  message.*text = "";
  const size_t offset =
      static_cast<size_t>(Message{}.getEncodedSize()) - 5;  // a length of four bytes, one NUL
  const int32_t lowest = std::numeric_limits<int32_t>::min();
  for (const int32_t length :
       {lowest, lowest + 1, -500'000'000, -1, 0, 2'000, std::numeric_limits<int32_t>::max()}) {
    std::vector<std::byte> encoding = WithoutTrailerOf(Encoded(message));
    PutInt32(encoding, offset, length);
    EXPECT_FALSE(Decodes<Message>(WithTrailer(encoding))) << length;
  }
}

TEST(HostileString, IsRejectedWhereItsLengthIsAbsurd) {
  RandomStream stream = TestStream(6);
  ExpectStringsOfAbsurdLengthRejected(ActorStatusOf(stream, 3, 3, 0), &actor_status_t::host);
  ExpectStringsOfAbsurdLengthRejected(LearnerStatusOf(stream, 0, 0), &learner_status_t::warning);
  ExpectStringsOfAbsurdLengthRejected(FlightOf(stream, 4, 0), &flight_t::policy);
  ExpectStringsOfAbsurdLengthRejected(ProbeOf(stream, 4, 0), &probe_t::host);
  ExpectStringsOfAbsurdLengthRejected(WorldOf(stream, 0, 0, 0), &world_t::entries);
}

template <class Message>
void ExpectOneNulAtTheEndOf(Message message, std::string Message::*text) {
  message.*text = "text";
  const size_t begin = static_cast<size_t>(Message{}.getEncodedSize()) - 1;
  const std::vector<std::byte> bytes = Encoded(message);
  EXPECT_TRUE(Decodes<Message>(bytes));
  for (const auto& [place, byte] : {std::pair<size_t, char>{0, 0}, {2, 0}, {4, 't'}}) {
    std::vector<std::byte> encoding = WithoutTrailerOf(bytes);
    ASSERT_NE(encoding.at(begin + place), static_cast<std::byte>(byte));
    encoding[begin + place] = static_cast<std::byte>(byte);
    EXPECT_FALSE(Decodes<Message>(WithTrailer(encoding))) << place;
  }
}

TEST(HostileString, HasOneNulAtItsEnd) {
  RandomStream stream = TestStream(8);
  ExpectOneNulAtTheEndOf(ActorStatusOf(stream, 2, 1, 0), &actor_status_t::host);
  ExpectOneNulAtTheEndOf(LearnerStatusOf(stream, 0, 0), &learner_status_t::warning);
  ExpectOneNulAtTheEndOf(FlightOf(stream, 3, 0), &flight_t::policy);
  ExpectOneNulAtTheEndOf(ProbeOf(stream, 3, 0), &probe_t::host);
  ExpectOneNulAtTheEndOf(WorldOf(stream, 0, 0, 0), &world_t::entries);
}

TEST(HostileString, IsRefusedWhereItsMessageIsTooLargeToBeEncodedAgain) {
  RandomStream stream = TestStream(9);
  learner_status_t message = LearnerStatusOf(stream, 0, 0);
  const auto largest = static_cast<int>(kMaximumEncodedBytes) - message.getEncodedSize();
  for (const int length : {largest, largest + 1}) {
    message.waiting_for.assign(static_cast<size_t>(length), 'w');
    std::vector<std::byte> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    EXPECT_EQ(Decodes<learner_status_t>(WithTrailer(bytes)), length == largest);
  }
}

TEST(HostileWireDeathTest, AMessageTooLargeForAFrameIsAProgrammersError) {
  RandomStream stream = TestStream(7);
  const weights_t message = WeightsOf(stream, kValuesPerChunk + 10);
  EXPECT_DEATH(Encoded(message), "kMaximumEncodedBytes");
}

}  // namespace
}  // namespace fresco
