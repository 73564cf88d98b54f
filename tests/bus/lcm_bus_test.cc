// The bus over LCM's own providers: memq within the process, udpm on ports of this test's own.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "bus/bus.h"
#include "core/clock.h"
#include "core/error.h"
#include "tests/bus/text_messages.h"

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
  try {
    PollUntil(*bus, [&] { return heard == 2; });
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "from the handler");
  }
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
  try {
    OpenLcmBus("tcpq://127.0.0.1:17404");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_status(), 2);
    EXPECT_NE(std::strstr(error.what(), "TCPService"), nullptr) << error.what();
  }
}

}  // namespace
}  // namespace fresco
