// Sends more to a socket than fits it, and reads it late.
#include "logs/bus_losses.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace fresco {
namespace {

TEST(DroppedDatagrams, AreThoseThatWereSentAndCannotBeRead) {
  const int receiver = socket(AF_INET, SOCK_DGRAM, 0);
  const int buffer_bytes = 20'000;
  setsockopt(receiver, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof buffer_bytes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(bind(receiver, generic, size), 0);
  ASSERT_EQ(getsockname(receiver, generic, &size), 0);
  const int64_t before = DroppedDatagrams();
  const int sender = socket(AF_INET, SOCK_DGRAM, 0);
  std::array<char, 1000> datagram{};
  int64_t unread = 500;
  for (int i = 0; i < 500; ++i) {
    ASSERT_GT(sendto(sender, datagram.data(), datagram.size(), 0, generic, size), 0);
  }
  while (recv(receiver, datagram.data(), datagram.size(), MSG_DONTWAIT) > 0) {
    --unread;
  }
  EXPECT_GT(unread, 0);
  EXPECT_EQ(DroppedDatagrams() - before, unread);
  close(sender);
  close(receiver);
}

}  // namespace
}  // namespace fresco
