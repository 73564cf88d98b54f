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

}  // namespace
}  // namespace fresco
