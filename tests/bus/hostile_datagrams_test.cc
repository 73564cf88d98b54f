// Datagrams that LCM itself reads wrongly, sent to a bus as raw UDP on a port of this test's own.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "bus/authenticated_bus.h"
#include "bus/bus.h"
#include "core/clock.h"
#include "tests/bus/text_messages.h"

namespace fresco {
namespace {

constexpr uint16_t kPort = 17405;
constexpr char kUrl[] = "udpm://239.255.76.67:17405";

std::string BigEndian(uint32_t value, int bytes = 4) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) {
    text += static_cast<char>(value >> (8 * i) & 0xFF);
  }
  return text;
}

std::string WholeMessage(const std::string& rest) {
  return "LC02" + BigEndian(0) + rest;
}

std::string Fragment(uint32_t message_bytes, uint32_t offset, uint32_t number, uint32_t count,
                     const std::string& rest) {
  return "LC03" + BigEndian(7) + BigEndian(message_bytes) + BigEndian(offset) + BigEndian(number, 2) +
         BigEndian(count, 2) + rest;
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

  /// Until the bus has handed out what was sent before.
  void SendAndPoll(Bus& bus, const std::vector<std::string>& datagrams) {
    for (const std::string& datagram : datagrams) {
      Send(datagram);
    }
    Send(WholeMessage(std::string("END\0now", 7)));
    const int64_t deadline_us = MonotonicMicroseconds() + 20'000'000;
    while (!ended_ && MonotonicMicroseconds() < deadline_us) {
      bus.Poll(10'000);
    }
    ASSERT_TRUE(ended_);
    ended_ = false;
  }

  /// The messages of channel A that reach the handler.
  std::vector<std::string> Heard(const std::vector<std::string>& datagrams) {
    const auto bus = OpenLcmBus(kUrl);
    std::vector<std::string> heard;
    bus->Subscribe("A", [&](auto message) { heard.push_back(Text(message)); });
    bus->Subscribe("END", [&](auto) { ended_ = true; });
    SendAndPoll(*bus, datagrams);
    return heard;
  }

  int socket_;
  bool ended_ = false;
};

// Followed by zeros in LCM's buffer, where the datagram before it was, on a channel that nobody reads.
const std::vector<std::string> kChannelWithoutEnd = {WholeMessage(std::string(64, '\0')), WholeMessage("A")};

TEST_F(HostileDatagrams, AChannelWithoutItsEndHasNoContent) {
  EXPECT_EQ(Heard(kChannelWithoutEnd), std::vector<std::string>{""});
}

TEST_F(HostileDatagrams, AChannelWithoutItsEndIsNotAuthentic) {
  const auto inner = OpenLcmBus(kUrl);
  const auto bus = MakeAuthenticatedBus(*inner, AuthenticationKey(Bytes(std::string(32, 'k'))));
  bus->Subscribe("A", [](auto) { FAIL() << "believed"; });
  inner->Subscribe("END", [&](auto) { ended_ = true; });
  SendAndPoll(*bus, kChannelWithoutEnd);
  EXPECT_EQ(bus->refused_messages(), 1);
}

TEST_F(HostileDatagrams, FragmentsAreNotRead) {
  const std::string start("A\0part", 6);
  EXPECT_EQ(
      Heard({
          Fragment(8, 0, 0, 2, start),
          Fragment(8, 4, 1, 2, "two!"),  // a message as LCM sends it
          Fragment(100, 0xFFFFFFF0, 0, 1, std::string("A\0", 2) + std::string(0x20, 'x')),  // behind its end
          Fragment(100, 0, 0, 1, "A"),
          std::string("LC03") + BigEndian(7),  // cut short
          Fragment(0xFFFFFFFF, 0, 0, 2, start),
          Fragment(1 << 28, 0, 0, 2, start),
          "LC",
          "",
          WholeMessage(std::string("A\0whole", 7)),
      }),
      std::vector<std::string>{"whole"});
}

TEST_F(HostileDatagrams, ADatagramOf60KilobytesIsAMessage) {
  const std::string content(60'000, 'x');
  EXPECT_EQ(Heard({WholeMessage(std::string("A\0", 2) + content)}), std::vector<std::string>{content});
}

}  // namespace
}  // namespace fresco
