// A program that has another key than the others, or none, or a key that they have not, learns why it hears
// nothing.
#include "msgs/key_mismatch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/authenticated_bus.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

AuthenticationKey KeyFrom(const std::string& secret) {
  return AuthenticationKey(std::as_bytes(std::span(secret)));
}

/// A program's side of the bus: what does not decode is noted.
class Program {
 public:
  Program(Bus& bus, const std::string& channel) : mismatch_(bus) {
    bus.Subscribe(channel, [this](auto bytes) {
      orders_t message{};
      if (Decode(bytes, message)) {
        ++decoded;
      } else {
        mismatch_.Note(bytes);
      }
    });
  }

  int decoded = 0;
  std::string Reason() const { return mismatch_.Reason(); }
  std::string News() { return mismatch_.News(); }

 private:
  KeyMismatch mismatch_;
};

class KeyMismatchTest : public ::testing::Test {
 protected:
  void Publish(Bus& bus) {
    RandomStream stream(1, RandomPurpose::kTest, 0, 0);
    bus.Publish("A", Encoded(OrdersOf(stream, 3)));
    while (bus_->Poll(0) > 0) {
    }
  }

  std::unique_ptr<Bus> bus_ = OpenLcmBus("memq://");
  std::unique_ptr<Bus> keyed_ = MakeAuthenticatedBus(*bus_, KeyFrom("a"));
  std::unique_ptr<Bus> otherwise_keyed_ = MakeAuthenticatedBus(*bus_, KeyFrom("b"));
};

TEST_F(KeyMismatchTest, IsNotedWithoutAKeyAmongThoseWhoHaveOne) {
  Program program(*bus_, "A");
  Publish(*bus_);
  EXPECT_EQ(program.decoded, 1);
  EXPECT_THAT(program.Reason(), IsEmpty());
  Publish(*keyed_);
  Publish(*keyed_);
  EXPECT_EQ(program.decoded, 1);
  EXPECT_THAT(program.Reason(), HasSubstr("2 messages"));
  EXPECT_THAT(program.Reason(), HasSubstr("no --key-file"));
}

TEST_F(KeyMismatchTest, IsNotedWithAKeyAmongThoseWhoHaveAnotherOrNone) {
  Program program(*keyed_, "A");
  Publish(*keyed_);
  EXPECT_EQ(program.decoded, 1);
  EXPECT_THAT(program.Reason(), IsEmpty());
  Publish(*bus_);
  EXPECT_THAT(program.Reason(), HasSubstr("1 messages"));
  Publish(*otherwise_keyed_);
  EXPECT_THAT(program.Reason(), HasSubstr("2 messages"));
  EXPECT_THAT(program.Reason(), HasSubstr("another key"));
  EXPECT_EQ(program.decoded, 1);
}

TEST_F(KeyMismatchTest, IsNewsOnce) {
  Program program(*keyed_, "A");
  EXPECT_THAT(program.News(), IsEmpty());
  Publish(*bus_);
  EXPECT_THAT(program.News(), HasSubstr("another key"));
  Publish(*bus_);
  EXPECT_THAT(program.News(), IsEmpty());
  EXPECT_THAT(program.Reason(), HasSubstr("2 messages"));
}

TEST_F(KeyMismatchTest, IsNotSuspectedInRubbish) {
  Program program(*bus_, "A");
  RandomStream stream(2, RandomPurpose::kTest, 0, 0);
  auto torn = Encoded(OrdersOf(stream, 3));
  torn.pop_back();
  bus_->Publish("A", torn);
  for (const size_t size : {0, 1, 31, 32, 36, 37, 100, 1350, 5000}) {
    bus_->Publish("A", std::vector<std::byte>(size, std::byte{7}));
  }
  while (bus_->Poll(0) > 0) {
  }
  EXPECT_EQ(program.decoded, 0);
  EXPECT_THAT(program.Reason(), IsEmpty());
}

}  // namespace
}  // namespace fresco
