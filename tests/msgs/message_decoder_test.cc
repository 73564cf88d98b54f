// Whatever stands in a log: told apart by LCM's fingerprint, with and without authentication.
#include "msgs/message_decoder.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bus/authenticated_bus.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

using Bytes = std::vector<std::byte>;
using Result = MessageDecoder::Result;

/// What the decoder hands out, encoded again; empty: nothing.
Bytes Handed(MessageDecoder& decoder, const Bytes& bytes, Result expected) {
  Bytes handed;
  EXPECT_EQ(decoder.Decode(bytes, [&](const auto& message) { handed = Encoded(message); }), expected);
  return handed;
}

template <class Message>
void ExpectDecoded(MessageDecoder& decoder) {
  RandomStream stream(5, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < 10; ++i) {
    Bytes bytes = Encoded(RandomMessage<Message>(stream));
    const Bytes plain = bytes;
    EXPECT_EQ(Handed(decoder, bytes, Result::kDecoded), plain);
    bytes.insert(bytes.end(), kAuthenticationTagBytes, std::byte{0x5a});
    EXPECT_EQ(Handed(decoder, bytes, Result::kDecoded), plain);
    bytes[12] ^= std::byte{1};
    EXPECT_TRUE(Handed(decoder, bytes, Result::kDamaged).empty());
  }
}

TEST(MessageDecoder, HandsOutEveryTypeWithAndWithoutATagBehindIt) {
  MessageDecoder decoder;
  ForEachMessageType([&]<class Message>(const Message&) { ExpectDecoded<Message>(decoder); });
}

TEST(MessageDecoder, TellsForeignMessagesFromDamagedOnes) {
  MessageDecoder decoder;
  RandomStream stream(5, RandomPurpose::kTest, 0, 0);
  const Bytes bytes = Encoded(RandomMessage<orders_t>(stream));
  for (size_t size = 0; size < bytes.size(); ++size) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size));
    EXPECT_TRUE(Handed(decoder, cut, size < 8 ? Result::kForeign : Result::kDamaged).empty()) << size;
  }
  EXPECT_TRUE(Handed(decoder, Bytes(100, std::byte{0}), Result::kForeign).empty());
}

void ExpectSeen(const transitions_t& message, const Bytes& bytes) {
  const auto header = PeekTransitions(bytes);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->identity, IdentityOf(message));
  EXPECT_EQ(header->transition_count, message.transition_count);
  EXPECT_EQ(header->order_index, message.order_index);
  EXPECT_EQ(header->actor_id, message.actor_id);
  EXPECT_EQ(header->first_transition, message.first_transition);
  EXPECT_EQ(header->first_field, message.first_field);
  EXPECT_EQ(header->ends_episode, message.ending != 0);
}

TEST(PeekTransitions, SeesWhatTheDecoderDecodes) {
  RandomStream stream(8, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < 50; ++i) {
    const auto message = RandomMessage<transitions_t>(stream);
    Bytes bytes = Encoded(message);
    ExpectSeen(message, bytes);
    bytes.insert(bytes.end(), kAuthenticationTagBytes, std::byte{7});
    ExpectSeen(message, bytes);
  }
}

TEST(PeekTransitions, RefusesWhatTheDecoderRefuses) {
  RandomStream stream(8, RandomPurpose::kTest, 1, 0);
  const auto message = RandomMessage<transitions_t>(stream);
  const Bytes bytes = Encoded(message);
  for (size_t i = 0; i < bytes.size(); ++i) {
    Bytes damaged = bytes;
    damaged[i] ^= std::byte{0x10};
    EXPECT_FALSE(PeekTransitions(damaged)) << i;
    EXPECT_FALSE(PeekTransitions(std::span(bytes).first(i))) << i;
  }
}

TEST(PeekTransitions, RefusesCountsThatDoNotFitTheSize) {
  RandomStream stream(8, RandomPurpose::kTest, 4, 0);
  const Bytes bytes = Encoded(RandomMessage<transitions_t>(stream));
  for (const size_t offset : {32u, 36u, 40u, 44u}) {  // of the four counts
    for (int count = -2; count < 520; ++count) {
      Bytes forged(bytes.begin(), bytes.end() - static_cast<ptrdiff_t>(kTrailerBytes));
      for (size_t byte = 0; byte < 4; ++byte) {
        forged[offset + byte] = static_cast<std::byte>(static_cast<uint32_t>(count) >> (24 - 8 * byte));
      }
      AppendTrailer(static_cast<int>(forged.size()), forged);
      transitions_t decoded;
      EXPECT_EQ(PeekTransitions(forged).has_value(), Decode(forged, decoded)) << offset << " " << count;
    }
  }
}

TEST(PeekIdentity, SeesTheRunOfEveryMessageAndNoneOfForeignOnes) {
  RandomStream stream(8, RandomPurpose::kTest, 2, 0);
  const auto status = RandomMessage<actor_status_t>(stream);
  const auto weights = RandomMessage<weights_t>(stream);
  EXPECT_EQ(PeekIdentity(Encoded(status)), IdentityOf(status));
  EXPECT_EQ(PeekIdentity(Encoded(weights)), IdentityOf(weights));
  EXPECT_EQ(PeekIdentity(Bytes(100, std::byte{1})), std::nullopt);
  EXPECT_EQ(PeekIdentity({}), std::nullopt);
  const Bytes bytes = Encoded(status);
  EXPECT_EQ(PeekIdentity(std::span(bytes).first(31)), std::nullopt);
}

TEST(PeekType, NamesTheType) {
  RandomStream stream(8, RandomPurpose::kTest, 3, 0);
  EXPECT_STREQ(PeekType(Encoded(RandomMessage<run_t>(stream))), "run_t");
  EXPECT_STREQ(PeekType(Encoded(RandomMessage<learner_status_t>(stream))), "learner_status_t");
  EXPECT_EQ(PeekType(Bytes(20, std::byte{0})), nullptr);
  EXPECT_EQ(PeekType(Bytes(3, std::byte{0})), nullptr);
}

}  // namespace
}  // namespace fresco
