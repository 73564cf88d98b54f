// Only what was made with the same key reaches a handler, and no message uses the heap once the bus is warm.
#include "bus/authenticated_bus.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "tests/bus/text_messages.h"
#include "tests/support/allocation_count.h"

namespace fresco {
namespace {

std::string Hexadecimal(const std::string& bytes) {
  std::string digits;
  for (const char byte : bytes) {
    for (const int shift : {4, 0}) {
      digits += "0123456789abcdef"[(static_cast<unsigned char>(byte) >> shift) & 15];
    }
  }
  return digits;
}

AuthenticationKey CountingKey() {
  std::string secret;
  for (char byte = 0; byte < 32; ++byte) {
    secret += byte;
  }
  return AuthenticationKey(Bytes(secret));
}

/// A bus without a key, on which everything happens, and two of its decorators.
class AuthenticatedBusTest : public ::testing::Test {
 protected:
  AuthenticatedBusTest() {
    receiver_->Subscribe("A", [this](auto message) { heard_.push_back(Text(message)); });
    raw_->Subscribe("A", [this](auto message) { on_the_wire_.push_back(Text(message)); });
  }

  void PollAll() {
    while (raw_->Poll(0) > 0) {
    }
  }

  /// What stands on the wire where `message` is published with the key.
  std::string OnTheWire(const std::string& message) {
    sender_->Publish("A", Bytes(message));
    PollAll();
    heard_.clear();
    return on_the_wire_.back();
  }

  /// Expects that exactly this many of the raw messages are refused, and nothing is heard.
  void ExpectRefused(const std::vector<std::string>& messages) {
    const int64_t before = receiver_->refused_messages();
    for (const std::string& message : messages) {
      raw_->Publish("A", Bytes(message));
      PollAll();  // one by one: a queue has an end
    }
    EXPECT_EQ(receiver_->refused_messages() - before, static_cast<int64_t>(messages.size()));
    EXPECT_TRUE(heard_.empty());
  }

  std::unique_ptr<Bus> raw_ = OpenLcmBus("memq://");
  std::unique_ptr<Bus> sender_ = MakeAuthenticatedBus(*raw_, CountingKey());
  std::unique_ptr<Bus> receiver_ = MakeAuthenticatedBus(*raw_, CountingKey());
  std::vector<std::string> heard_;
  std::vector<std::string> on_the_wire_;
};

TEST_F(AuthenticatedBusTest, DeliversWhatWasMadeWithItsKey) {
  const std::vector<std::string> messages = {"", "one", std::string("two\0three", 9), std::string(1318, 'x')};
  for (const std::string& message : messages) {
    EXPECT_TRUE(sender_->Publish("A", Bytes(message)));
  }
  PollAll();
  EXPECT_EQ(heard_, messages);
  EXPECT_EQ(receiver_->refused_messages(), 0);
}

// python3 -c "import hashlib; k = hashlib.blake2b(bytes(range(32)), digest_size=32).digest();
// [print(hashlib.blake2b(b'A\0' + m, key=k, digest_size=32).hexdigest()) for m in (b'', b'abc')]"
TEST_F(AuthenticatedBusTest, AppendsTheKeyedBlake2bOfChannelZeroAndContent) {
  EXPECT_EQ(Hexadecimal(OnTheWire("")), "9ddc0ceb31e598130889bda7f99a6f9267d45fadaeba9b8a0900ba2e1d9a548b");
  EXPECT_EQ(Hexadecimal(OnTheWire("abc")),
            "616263"
            "1f174356339372f487d9c7d0d8679de07d53c0dd59537404cb495e0f8c742026");
}

TEST_F(AuthenticatedBusTest, RefusesAnotherKeyAndNone) {
  std::string secret(32, 'k');
  const auto stranger = MakeAuthenticatedBus(*raw_, AuthenticationKey(Bytes(secret)));
  stranger->Publish("A", Bytes("with another key"));
  PollAll();
  EXPECT_EQ(receiver_->refused_messages(), 1);
  EXPECT_EQ(stranger->refused_messages(), 0);  // it has no subscription
  ExpectRefused({"without a key", std::string(100, 'x')});
}

TEST_F(AuthenticatedBusTest, RefusesAMessageWithAnyBitFlipped) {
  const std::string sound = OnTheWire("content");
  std::vector<std::string> flipped;
  for (size_t bit = 0; bit < 8 * sound.size(); ++bit) {
    flipped.push_back(sound);
    flipped.back()[bit / 8] = static_cast<char>(flipped.back()[bit / 8] ^ (1 << bit % 8));
  }
  ExpectRefused(flipped);
}

TEST_F(AuthenticatedBusTest, RefusesAMessageThatIsTruncatedLongerOrEmpty) {
  const std::string sound = OnTheWire("content");
  std::vector<std::string> others = {sound + '\0', '\0' + sound, sound + sound.substr(7)};
  for (size_t size = 0; size < sound.size(); ++size) {
    others.push_back(sound.substr(0, size));
    others.push_back(sound.substr(sound.size() - size));
  }
  ExpectRefused(others);
}

TEST_F(AuthenticatedBusTest, RefusesAMessageOfAnotherChannel) {
  std::string moved;
  raw_->Subscribe("AB", [&](auto message) { moved = Text(message); });
  sender_->Publish("AB", Bytes("content"));
  PollAll();
  ASSERT_EQ(moved.size(), 7u + kAuthenticationTagBytes);
  ExpectRefused({moved, "B" + moved});
}

TEST_F(AuthenticatedBusTest, TakesTheSameMessageAgain) {  // what is in it must bear that
  const std::string sound = OnTheWire("content");
  raw_->Publish("A", Bytes(sound));
  raw_->Publish("A", Bytes(sound));
  PollAll();
  EXPECT_EQ(heard_, (std::vector<std::string>{"content", "content"}));
}

TEST_F(AuthenticatedBusTest, PublishesFromSeveralThreads) {
  constexpr int kThreads = 4;
  constexpr int kEach = 200;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([this, i] {
        for (int j = 0; j < kEach; ++j) {
          sender_->Publish("A", Bytes(std::string(static_cast<size_t>(1 + 50 * i + j), 'm')));
        }
      });
    }
  }
  PollAll();
  EXPECT_EQ(heard_.size(), static_cast<size_t>(kThreads * kEach));
  EXPECT_EQ(receiver_->refused_messages(), 0);
}

#ifndef FRESCO_SANITIZED

/// Hands every message to the one handler at once.
class DirectBus : public Bus {
 public:
  bool Publish(const std::string&, std::span<const std::byte> message) override {
    handler_(message);
    return true;
  }
  void Subscribe(const std::string&, BusHandler handler, int) override { handler_ = std::move(handler); }
  void SubscribeToAll(BusEventHandler) override {}
  int Poll(int64_t, int) override { return 0; }

 private:
  BusHandler handler_;
};

TEST(AuthenticatedBusAllocations, DoNotHappenForAMessageOnceWarm) {
  DirectBus direct;
  const std::vector<std::byte> content(1318, std::byte{7});
  const auto bus = MakeAuthenticatedBus(direct, AuthenticationKey(content));
  const std::string channel = "A_CHANNEL_WITH_A_LONG_NAME";
  size_t heard = 0;
  bus->Subscribe(channel, [&](auto message) { heard += message.size(); });
  bus->Publish(channel, content);
  const int64_t before = AllocationCount();
  for (int i = 0; i < 100; ++i) {
    bus->Publish(channel, content);
    direct.Publish(channel, content);  // refused
  }
  EXPECT_EQ(AllocationCount(), before);
  EXPECT_EQ(heard, 101 * content.size());
  EXPECT_EQ(bus->refused_messages(), 100);
}

#endif

}  // namespace
}  // namespace fresco
