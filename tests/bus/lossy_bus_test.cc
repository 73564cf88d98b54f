#include "bus/lossy_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "tests/bus/text_messages.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

/// Notes what is published.
class NotingBus : public Bus {
 public:
  bool Publish(const std::string&, std::span<const std::byte> message) override {
    messages.emplace_back(reinterpret_cast<const char*>(message.data()), message.size());
    return true;
  }
  void Subscribe(const std::string&, BusHandler, int) override {}
  void SubscribeToAll(BusEventHandler) override {}
  int Poll(int64_t, int) override { return 0; }

  std::vector<std::string> messages;
};

std::vector<std::string> Disturbed(LossOptions options, int count) {
  NotingBus inner;
  const auto bus = MakeLossyBus(inner, options);
  for (int i = 0; i < count; ++i) {
    const std::string message = std::to_string(1'000'000 + i);
    bus->Publish("A", Bytes(message));
  }
  return inner.messages;
}

TEST(LossyBus, ChangesNothingWithoutOptions) {
  const auto messages = Disturbed({}, 100);
  ASSERT_EQ(messages.size(), 100u);
  EXPECT_TRUE(std::is_sorted(messages.begin(), messages.end()));
}

TEST(LossyBus, DropsAndRepeatsAboutAsOftenAsAsked) {
  constexpr int kMessages = 10000;
  LossOptions options;
  options.drop = 0.1;
  EXPECT_NEAR(static_cast<double>(Disturbed(options, kMessages).size()), 0.9 * kMessages,
              150);  // five deviations
  options = {};
  options.duplicate = 0.1;
  EXPECT_NEAR(static_cast<double>(Disturbed(options, kMessages).size()), 1.1 * kMessages, 150);
}

TEST(LossyBus, DelaysByAtMostSixteenMessages) {
  LossOptions options;
  options.delay = 0.3;
  constexpr int kMessages = 2000;
  auto messages = Disturbed(options, kMessages);
  EXPECT_FALSE(std::is_sorted(messages.begin(), messages.end()));
  EXPECT_GE(messages.size(), static_cast<size_t>(kMessages - 16));
  std::string latest;
  for (const std::string& message : messages) {
    EXPECT_GE(std::stoi(message) + 16, latest.empty() ? 0 : std::stoi(latest));
    latest = std::max(latest, message);
  }
}

TEST(LossyBus, FlipsOneBitOfACorruptedMessage) {
  LossOptions options;
  options.corrupt = 1;
  const auto messages = Disturbed(options, 50);
  for (int i = 0; i < 50; ++i) {
    const std::string sent = std::to_string(1'000'000 + i);
    int flipped = 0;
    for (size_t byte = 0; byte < sent.size(); ++byte) {
      flipped +=
          std::popcount(static_cast<unsigned char>(sent[byte] ^ messages[static_cast<size_t>(i)][byte]));
    }
    EXPECT_EQ(flipped, 1);
  }
}

TEST(LossyBus, DisturbsTheSameWayForTheSameSeed) {
  LossOptions options{0.1, 0.1, 0.1, 0.1, 5};
  EXPECT_EQ(Disturbed(options, 500), Disturbed(options, 500));
  LossOptions other = options;
  other.seed = 6;
  EXPECT_NE(Disturbed(options, 500), Disturbed(other, 500));
}

TEST(LossOptions, AreReadFromTextAndWrittenToIt) {
  const LossOptions options = ParseLossOptions("drop=0.01,delay=1,corrupt=0.5,seed=12");
  EXPECT_EQ(options.drop, 0.01);
  EXPECT_EQ(options.duplicate, 0);
  EXPECT_EQ(options.delay, 1);
  EXPECT_EQ(options.corrupt, 0.5);
  EXPECT_EQ(options.seed, 12u);
  EXPECT_EQ(ToText(ParseLossOptions(ToText(options))), ToText(options));
}

TEST(LossOptions, NameThePartThatIsWrong) {
  for (const std::string part :
       {"drop", "drop=", "drop=x", "drop=1.5", "drop=-0.1", "loss=0.1", "seed=-1", "=1"}) {
    EXPECT_THAT(ErrorOf([&] { ParseLossOptions("delay=0.1," + part); }),
                testing::HasSubstr("found \"" + part + "\""));
  }
}

}  // namespace
}  // namespace fresco
