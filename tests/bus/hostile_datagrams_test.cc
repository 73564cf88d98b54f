// Datagrams that LCM itself reads wrongly, sent to a bus as raw UDP on a port of this test's own.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "bus/bus.h"
#include "core/clock.h"
#include "core/error.h"
#include "tests/bus/lcm_datagrams.h"
#include "tests/bus/text_messages.h"

namespace fresco {
namespace {

constexpr uint16_t kPort = 17405;
constexpr char kUrl[] = "udpm://239.255.76.67:17405";

/// LCM's buffer holds zeros, of the first, which is none of LCM's, where the second one's channel should end.
std::vector<std::string> ChannelWithoutEnd() {
  return {std::string(64, '\0'), WholeDatagram("A")};
}

/// A message as LCM sends it where it needs two datagrams.
std::vector<std::string> TwoFragments() {
  return {FragmentDatagram({7, 8, 0, 0, 2}, OnA("part")), FragmentDatagram({7, 8, 4, 1, 2}, "two!")};
}

class HostileDatagrams : public ::testing::Test {
 protected:
  HostileDatagrams() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    const unsigned char ttl = 0;
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl));
  }
  ~HostileDatagrams() override { close(socket_); }

  void Send(const std::string& datagram) const {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(kPort);
    inet_pton(AF_INET, "239.255.76.67", &address.sin_addr);
    ASSERT_EQ(sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&address),
                     sizeof(address)),
              static_cast<ssize_t>(datagram.size()));
  }

  /// Returns once the bus has handed out what was sent before the end.
  void SendAndPoll(Bus& bus, const std::vector<std::string>& datagrams) {
    for (const std::string& datagram : datagrams) {
      Send(datagram);
    }
    Send(WholeDatagram(std::string("END\0now", 7)));
    const int64_t deadline_us = MonotonicMicroseconds() + 20'000'000;
    while (!ended_ && MonotonicMicroseconds() < deadline_us) {
      bus.Poll(10'000);
    }
    ASSERT_TRUE(ended_);
    ended_ = false;
  }

  /// The messages of channel A that reach its handler.
  std::vector<std::string> HeardOnA(const std::vector<std::string>& datagrams) {
    const auto bus = OpenLcmBus(kUrl);
    std::vector<std::string> heard;
    bus->Subscribe("A", [&](auto message) { heard.push_back(Text(message)); });
    bus->Subscribe("AND MORE", [](auto) {});
    bus->Subscribe("END", [&](auto) { ended_ = true; });
    SendAndPoll(*bus, datagrams);
    dropped_ = Dropped();
    return heard;
  }

  /// The same of a bus that hears all channels.
  std::vector<std::string> HeardOfAllOnA(const std::vector<std::string>& datagrams) {
    const auto bus = OpenLcmBus(kUrl);
    std::vector<std::string> heard;
    bus->SubscribeToAll([&](const LcmEvent& event) {
      if (event.channel == "A") {
        heard.push_back(Text(event.message));
      }
      ended_ = ended_ || event.channel == "END";
    });
    SendAndPoll(*bus, datagrams);
    unheard_ = bus->unheard();
    return heard;
  }

  /// Of the sockets on this test's port: what the kernel kept from them.
  static std::vector<int64_t> DropsOnPort() {
    std::ifstream table("/proc/net/udp");
    std::vector<int64_t> drops;
    for (std::string line; std::getline(table, line);) {
      std::istringstream fields(line);
      const std::vector<std::string> words(std::istream_iterator<std::string>(fields), {});
      if (words.size() > 2 && words[1].ends_with(fmt::format(":{:04X}", kPort))) {
        drops.push_back(std::stoll(words.back()));
      }
    }
    return drops;
  }

  static int64_t Dropped() {
    const auto drops = DropsOnPort();
    return std::accumulate(drops.begin(), drops.end(), int64_t{0});
  }

  static int SocketsOnPort() { return static_cast<int>(DropsOnPort().size()); }

  int socket_;
  bool ended_ = false;
  int64_t dropped_ = 0;
  UnheardTraffic unheard_;
};

TEST_F(HostileDatagrams, OnlyWholeMessagesOfTheChannelsThatAreReadReachLcm) {
  std::vector<std::string> hostile = {
      FragmentDatagram({7, 100, 0xFFFFFFF0, 0, 1}, OnA(std::string(0x20, 'x'))),  // behind its end
      FragmentDatagram({7, 100, 0, 0, 1}, "A"),                                   // cut short
      "LC03" + BigEndian(7, 4),
      FragmentDatagram({7, 0xFFFFFFFF, 0, 0, 2}, OnA("part")),
      FragmentDatagram({7, 1 << 28, 0, 0, 2}, OnA("part")),
      "LC",
      "",
      WholeDatagram("AND"),
      WholeDatagram(std::string("AND MOR\0x", 9)),
      WholeDatagram(std::string("B\0x", 3)),
      WholeDatagram(std::string("AA\0x", 4)),
      WholeDatagram(std::string(200, 'A')),
  };
  for (const auto& more : {TwoFragments(), ChannelWithoutEnd()}) {
    hostile.insert(hostile.end(), more.begin(), more.end());
  }
  std::vector<std::string> sent = hostile;
  sent.push_back(WholeDatagram(OnA("")));
  sent.push_back(WholeDatagram(OnA("whole")));
  EXPECT_EQ(HeardOnA(sent), (std::vector<std::string>{"", "whole"}));
  EXPECT_EQ(dropped_, static_cast<int64_t>(hostile.size()));
}

TEST_F(HostileDatagrams, ADatagramOf60KilobytesIsAMessage) {
  const std::string content(60'000, 'x');
  EXPECT_EQ(HeardOnA({WholeDatagram(OnA(content))}), std::vector<std::string>{content});
}

TEST_F(HostileDatagrams, WhoHearsAllChannelsHearsNoMessageWhoseChannelDoesNotEnd) {
  EXPECT_EQ(HeardOfAllOnA(ChannelWithoutEnd()), std::vector<std::string>{});
  EXPECT_EQ(unheard_.refused_packets, 2);
}

TEST_F(HostileDatagrams, WhoHearsAllChannelsHearsMessagesOfManyDatagrams) {
  EXPECT_EQ(HeardOfAllOnA(TwoFragments()), std::vector<std::string>{"parttwo!"});
  EXPECT_EQ(unheard_.refused_packets, 0);
}

TEST_F(HostileDatagrams, WhoHearsAllChannelsLivesThroughFragmentsOutsideOfTheirMessage) {
  std::vector<std::string> datagrams;
  for (const uint32_t offset : {0xFFFFFFF0u, 0x7FFFFFFFu, 1000u}) {
    datagrams.push_back(FragmentDatagram({1, 64, offset, 0, 1}, OnA(std::string(20, 'x'))));
    datagrams.push_back(FragmentDatagram({2, 64, offset, 1, 2}, std::string(20, 'x')));
  }
  const auto refused = static_cast<int64_t>(datagrams.size());
  datagrams.insert(datagrams.end(), 3, FragmentDatagram({3, 96, 0, 0, 3}, OnA(std::string(32, 'x'))));
  for (const std::string& more : TwoFragments()) {
    datagrams.push_back(more);
  }
  EXPECT_EQ(HeardOfAllOnA(datagrams), std::vector<std::string>{"parttwo!"});
  EXPECT_EQ(unheard_.refused_packets, refused);
  EXPECT_EQ(unheard_.incomplete_messages, 1);
}

TEST_F(HostileDatagrams, WhoHearsAllChannelsFindsWhatArrivedWhileNobodyPolled) {
  const auto bus = OpenLcmBus(kUrl);
  int heard = 0;
  bus->SubscribeToAll([&](const LcmEvent& event) { heard += event.message.size() == 1000; });
  const std::string datagram = WholeDatagram(OnA(std::string(1000, 'x')));
  constexpr int kRounds = 120;  // in all more than the kernel's buffer has room for
  constexpr int kMessages = 100;
  const int64_t deadline_us = MonotonicMicroseconds() + 20'000'000;
  for (int round = 1; round <= kRounds; ++round) {
    for (int i = 0; i < kMessages; ++i) {
      Send(datagram);
    }
    Send("no message");
    while (bus->unheard().refused_packets < round && MonotonicMicroseconds() < deadline_us) {
      std::this_thread::yield();
    }
  }
  EXPECT_EQ(bus->Poll(0, 2 * kRounds * kMessages), kRounds * kMessages);
  EXPECT_EQ(heard, kRounds * kMessages);
}

TEST_F(HostileDatagrams, NothingIsOpenOnThePortUntilSomebodySubscribes) {
  const auto bus = OpenLcmBus(kUrl);
  EXPECT_TRUE(bus->Publish("A", Bytes("content")));
  EXPECT_EQ(bus->Poll(1'000), 0);
  EXPECT_EQ(SocketsOnPort(), 0);
  bus->SubscribeToAll([](const LcmEvent&) {});
  EXPECT_EQ(SocketsOnPort(), 1);  // LCM's own would be a second
  bus->Subscribe("A", [](auto) {});
  EXPECT_EQ(SocketsOnPort(), 2);
}

TEST_F(HostileDatagrams, AFilterIsOfOneBusOnly) {
  const auto other = OpenLcmBus(kUrl);
  other->Subscribe("B", [](auto) {});
  EXPECT_EQ(HeardOfAllOnA(TwoFragments()), std::vector<std::string>{"parttwo!"});
}

TEST_F(HostileDatagrams, EveryLengthOfAChannelsNameIsTold) {
  for (size_t length = 1; length <= 63; ++length) {
    const std::string channel(length, 'C');
    const std::string other = channel.substr(1) + "D";
    const std::string longer = channel + "C";
    const auto bus = OpenLcmBus(kUrl);
    std::vector<std::string> heard;
    bus->Subscribe(channel, [&](auto message) { heard.push_back(Text(message)); });
    bus->Subscribe("END", [&](auto) { ended_ = true; });
    SendAndPoll(*bus, {WholeDatagram(other + '\0'), WholeDatagram(longer + '\0'), WholeDatagram(channel),
                       WholeDatagram(channel + '\0'), WholeDatagram(channel + '\0' + "x")});
    EXPECT_EQ(heard, (std::vector<std::string>{"", "x"})) << length;
    EXPECT_EQ(Dropped(), 3) << length;
  }
}

TEST_F(HostileDatagrams, AChannelThatLcmCantHaveIsRefused) {
  for (const char* url : {kUrl, "memq://"}) {
    const auto bus = OpenLcmBus(url);
    EXPECT_NO_THROW(bus->Subscribe(std::string(63, 'A'), [](auto) {}));
    EXPECT_THROW(bus->Subscribe(std::string(64, 'A'), [](auto) {}), Error);
    EXPECT_THROW(bus->Subscribe(std::string("A\0B", 3), [](auto) {}), Error);
  }
}

}  // namespace
}  // namespace fresco
