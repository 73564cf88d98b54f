// What is sent arrives as it was, with its run and the time; what does not decode is counted; and a program
// that has another key than the others, or none, or a key that they have not, learns why it hears nothing.
#include "msgs/message_bus.h"

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

template <class AnyBus>
void PollAll(AnyBus& bus) {
  while (bus.Poll(0) > 0) {
  }
}

/// A program's side of the bus.
class Program {
 public:
  Program(Bus& bus, const std::string& channel) : bus_(bus) {
    bus_.Subscribe<orders_t>(channel, [this](const orders_t&) { ++decoded; });
  }

  int decoded = 0;
  std::string Reason() const { return bus_.KeyMismatch(); }
  std::string News() { return bus_.KeyMismatchNews(); }
  int64_t malformed() const { return bus_.malformed_messages(); }

 private:
  MessageBus bus_;
};

class KeyMismatchTest : public ::testing::Test {
 protected:
  void Publish(Bus& bus) {
    RandomStream stream(1, RandomPurpose::kTest, 0, 0);
    bus.Publish("A", Encoded(OrdersOf(stream, 3)));
    PollAll(*bus_);
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
  PollAll(*bus_);
  EXPECT_EQ(program.decoded, 0);
  EXPECT_EQ(program.malformed(), 10);
  EXPECT_THAT(program.Reason(), IsEmpty());
}

TEST(MessageBus, HandsOutWhatWasSentWithItsRunAndTheTimeOfSending) {
  const std::unique_ptr<Bus> bus = OpenLcmBus("memq://");
  MessageBus sender(*bus);
  MessageBus receiver(*bus);
  std::vector<orders_t> received;
  receiver.Subscribe<orders_t>("A", [&](const orders_t& message) { received.push_back(message); });
  RandomStream stream(3, RandomPurpose::kTest, 0, 0);
  orders_t sent = OrdersOf(stream, 3);
  const int64_t before = WallMicroseconds();
  EXPECT_TRUE(sender.Publish("A", sent, {77, 0xfeedu}));
  EXPECT_TRUE(sender.Publish("B", orders_t(sent), {77, 0xfeedu}));
  PollAll(receiver);
  ASSERT_EQ(received.size(), 1u);
  EXPECT_EQ(IdentityOf(received[0]), (RunIdentity{77, 0xfeedu}));
  EXPECT_GE(received[0].utime, before);
  EXPECT_LE(received[0].utime, WallMicroseconds());
  orders_t expected = sent;
  Stamp(expected, {77, 0xfeedu}, received[0].utime);
  EXPECT_EQ(Encoded(received[0]), Encoded(expected));
  EXPECT_EQ(receiver.malformed_messages(), 0);
}

}  // namespace
}  // namespace fresco
