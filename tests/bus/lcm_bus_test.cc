// The bus over LCM's own providers: memq within the process, udpm on ports of this test's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "bus/bus.h"
#include "core/clock.h"
#include "tests/bus/text_messages.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

/// Polls until `done` or a deadline far beyond what is needed.
template <class Done>
bool PollUntil(Bus& bus, Done done) {
  const int64_t deadline_us = MonotonicMicroseconds() + 20'000'000;
  while (!done() && MonotonicMicroseconds() < deadline_us) {
    bus.Poll(10'000);
  }
  return done();
}

TEST(LcmBus, DeliversWholeMessagesInOrder) {
  const auto bus = OpenLcmBus("memq://");
  std::vector<std::string> heard;
  bus->Subscribe("A", [&](auto message) { heard.push_back(Text(message)); });
  for (const std::string& message :
       {std::string("one"), std::string("two\0three", 9), std::string(1350, 'x')}) {
    EXPECT_TRUE(bus->Publish("A", Bytes(message)));
  }
  ASSERT_TRUE(PollUntil(*bus, [&] { return heard.size() == 3; }));
  EXPECT_EQ(heard[0], "one");
  EXPECT_EQ(heard[1], std::string("two\0three", 9));
  EXPECT_EQ(heard[2], std::string(1350, 'x'));
}

TEST(LcmBus, TakesChannelNamesLiterally) {
  const auto bus = OpenLcmBus("memq://");
  int exact = 0;
  int end = 0;
  bus->Subscribe("A.B*", [&](auto) { ++exact; });
  bus->Subscribe("END", [&](auto) { ++end; });
  for (const std::string channel : {"AxB*", "A.BBB", "A.B", "xA.B*", "A.B*x", "A.B*", "END"}) {
    bus->Publish(channel, Bytes("m"));
  }
  ASSERT_TRUE(PollUntil(*bus, [&] { return end == 1; }));
  EXPECT_EQ(exact, 1);
}

TEST(LcmBus, KeepsThousandsOfMessagesThatWaitForPoll) {
  for (const std::string url : {"memq://", "udpm://239.255.76.67:17401"}) {
    const auto bus = OpenLcmBus(url);
    constexpr int kMessages = 2000;  // LCM's own limit would be 30
    int heard = 0;
    bus->Subscribe("A", [&](auto) { ++heard; });
    for (int i = 0; i < kMessages; ++i) {
      bus->Publish("A", Bytes(std::to_string(i)));
    }
    EXPECT_TRUE(PollUntil(*bus, [&] { return heard == kMessages; })) << url << " " << heard;
  }
}

TEST(LcmBus, CarriesMessagesFromOneObjectToAnother) {
  const auto sender = OpenLcmBus("udpm://239.255.76.67:17402");
  const auto receiver = OpenLcmBus("udpm://239.255.76.67:17402");
  std::string heard;
  receiver->Subscribe("A", [&](auto message) { heard = Text(message); });
  EXPECT_TRUE(PollUntil(*receiver, [&] {
    sender->Publish("A", Bytes("over the network"));
    return !heard.empty();
  }));
  EXPECT_EQ(heard, "over the network");
}

TEST(LcmBus, HearsLargeMessagesOfAllChannelsWithTheirTimes) {
  const auto sender = OpenLcmBus("udpm://239.255.76.67:17406");
  const auto receiver = OpenLcmBus("udpm://239.255.76.67:17406");
  std::string large(1'000'000, '\0');
  for (size_t i = 0; i < large.size(); ++i) {
    large[i] = static_cast<char>(i * i >> 7);
  }
  std::string heard;
  int64_t heard_utime = 0;
  int64_t events = 0;
  receiver->SubscribeToAll([&](const LcmEvent& event) {
    EXPECT_EQ(event.number, events++);
    EXPECT_EQ(event.channel, "LARGE");
    heard = Text(event.message);
    heard_utime = event.utime;
  });
  const int64_t begin_utime = WallMicroseconds();
  EXPECT_TRUE(PollUntil(*receiver, [&] {
    sender->Publish("LARGE", Bytes(large));
    return !heard.empty();
  }));
  EXPECT_TRUE(heard == large);  // too much to print
  EXPECT_GE(heard_utime, begin_utime);
  EXPECT_LE(heard_utime, WallMicroseconds());
  EXPECT_EQ(receiver->unheard().refused_packets, 0);
}

TEST(LcmBus, HearsOneChannelBesideAllChannels) {
  const auto bus = OpenLcmBus("udpm://239.255.76.67:17407");
  std::vector<std::string> heard_all;
  std::vector<std::string> heard_one;
  bus->SubscribeToAll([&](const LcmEvent& event) {
    if (event.channel != "LCM_SELF_TEST") {  // with which LCM opens its own socket
      heard_all.push_back(Text(event.message));
    }
  });
  bus->Subscribe("A", [&](auto message) { heard_one.push_back(Text(message)); });
  const std::vector<std::pair<std::string, std::string>> sent = {{"A", "1"}, {"B", "2"}, {"A", "3"}};
  for (const auto& [channel, message] : sent) {
    bus->Publish(channel, Bytes(message));
  }
  EXPECT_TRUE(PollUntil(*bus, [&] { return heard_all.size() == 3 && heard_one.size() == 2; }));
  EXPECT_EQ(heard_all, (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(heard_one, (std::vector<std::string>{"1", "3"}));
}

TEST(LcmBus, GoesOnBehindAMessageOfAllChannelsWhoseHandlerThrew) {
  const auto bus = OpenLcmBus("udpm://239.255.76.67:17408");
  std::vector<std::string> heard;
  bus->SubscribeToAll([&](const LcmEvent& event) {
    heard.push_back(Text(event.message));
    if (heard.size() == 1) {
      throw Failure("from the handler");
    }
  });
  for (const std::string message : {"1", "2", "3"}) {
    bus->Publish("A", Bytes(message));
  }
  EXPECT_THROW(PollUntil(*bus, [&] { return heard.size() > 1; }), Error);
  EXPECT_EQ(bus->Poll(1'000'000, 1), 1);
  EXPECT_EQ(heard, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(bus->Poll(1'000'000, 5), 1);
  EXPECT_EQ(heard.back(), "3");
}

TEST(LcmBus, TakesMessagesFromSeveralThreads) {
  const auto bus = OpenLcmBus("udpm://239.255.76.67:17403");
  int heard = 0;
  bus->Subscribe("A", [&](auto) { ++heard; });
  constexpr int kThreads = 4;
  constexpr int kEach = 250;
  std::vector<std::jthread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] {
      for (int j = 0; j < kEach; ++j) {
        bus->Publish("A", Bytes("m"));
      }
    });
  }
  EXPECT_TRUE(PollUntil(*bus, [&] { return heard == kThreads * kEach; })) << heard;
}

TEST(LcmBus, ThrowsAHandlersExceptionFromPollAndGoesOn) {
  const auto bus = OpenLcmBus("memq://");
  int heard = 0;
  bus->Subscribe("A", [&](auto) {
    if (++heard == 1) {
      throw Failure("from the handler");
    }
  });
  bus->Publish("A", Bytes("1"));
  bus->Publish("A", Bytes("2"));
  const auto poll = [&] { PollUntil(*bus, [&] { return heard == 2; }); };
  EXPECT_EQ(ErrorOf(poll, ErrorKind::kFailure), "from the handler");
  EXPECT_TRUE(PollUntil(*bus, [&] { return heard == 2; }));
}

TEST(LcmBus, AHandlerMayPublish) {
  const auto bus = OpenLcmBus("memq://");
  bool answered = false;
  bus->Subscribe("QUESTION", [&](auto) { bus->Publish("ANSWER", Bytes("yes")); });
  bus->Subscribe("ANSWER", [&](auto) { answered = true; });
  bus->Publish("QUESTION", Bytes("?"));
  EXPECT_TRUE(PollUntil(*bus, [&] { return answered; }));
}

TEST(LcmBus, PollWaitsForItsTimeoutAndHandlesNoMoreThanItsMaximum) {
  const auto bus = OpenLcmBus("memq://");
  bus->Subscribe("A", [](auto) {});
  const int64_t begin_us = MonotonicMicroseconds();
  EXPECT_EQ(bus->Poll(3'000), 0);
  EXPECT_GE(MonotonicMicroseconds() - begin_us, 2'900);
  for (int i = 0; i < 5; ++i) {
    bus->Publish("A", Bytes("m"));
  }
  EXPECT_EQ(bus->Poll(1'000'000, 3), 3);
  EXPECT_EQ(bus->Poll(1'000'000, 3), 2);
}

TEST(LcmBus, SaysHowToStartAServerWhereNoneAnswers) {
  EXPECT_THAT(ErrorOf([] { OpenLcmBus("tcpq://127.0.0.1:17404"); }), testing::HasSubstr("TCPService"));
}

}  // namespace
}  // namespace fresco
