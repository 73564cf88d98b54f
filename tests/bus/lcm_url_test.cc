#include "bus/lcm_url.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/bus.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(LcmUrl, GetsTheDefaultsThatItDoesNotName) {
  EXPECT_EQ(ParseLcmUrl("udpm://239.255.76.67:7667").text,
            "udpm://239.255.76.67:7667?recv_buf_size=4194304&ttl=0");
  EXPECT_EQ(ParseLcmUrl("udpm://224.0.0.1:1?ttl=1").text, "udpm://224.0.0.1:1?recv_buf_size=4194304&ttl=1");
  EXPECT_EQ(ParseLcmUrl("udpm://239.1.1.1:65535?recv_buf_size=9&ttl=255").text,
            "udpm://239.1.1.1:65535?recv_buf_size=9&ttl=255");
  EXPECT_EQ(ParseLcmUrl("udpm://239.1.1.1:07667?recv_buf_size=010&ttl=01").text,  // no octal numbers
            "udpm://239.1.1.1:7667?recv_buf_size=10&ttl=1");
  EXPECT_EQ(ParseLcmUrl("tcpq://localhost:0010").text, "tcpq://localhost:10");
  EXPECT_EQ(ParseLcmUrl("memq://").text, "memq://");
  EXPECT_EQ(ParseLcmUrl("tcpq://localhost:7700").text, "tcpq://localhost:7700");
  EXPECT_NO_THROW(ParseLcmUrl(kDefaultLcmUrl));
}

TEST(LcmUrl, HasAnEndpointIfItIsMulticast) {
  const auto endpoint = ParseLcmUrl("udpm://239.255.76.67:17667?recv_buf_size=1000").multicast;
  ASSERT_TRUE(endpoint);
  EXPECT_EQ(endpoint->group, "239.255.76.67");
  EXPECT_EQ(endpoint->port, 17667);
  EXPECT_EQ(endpoint->receive_buffer_bytes, 1000);
  EXPECT_FALSE(ParseLcmUrl("tcpq://localhost:7700").multicast);
  EXPECT_FALSE(ParseLcmUrl("memq://").multicast);
}

TEST(LcmUrl, IsRefusedWithItsOffendingPartAndAnExample) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"", "scheme \"\""},
      {"udpm", "scheme"},
      {"udp://239.255.76.67:7667", "scheme \"udp\""},
      {"file://run.log", "logs"},
      {"udpm://", "group:port"},
      {"udpm://239.255.76.67", "239.255.76.67"},
      {"udpm://239.255.76.67:0", "\"0\""},
      {"udpm://239.255.76.67:65536", "65536"},
      {"udpm://239.255.76.67:port", "\"port\""},
      {"udpm://10.0.0.1:7667", "10.0.0.1"},
      {"udpm://localhost:7667", "localhost"},
      {"udpm://239.255.76.67:7667?ttl=256", "256"},
      {"udpm://239.255.76.67:7667?ttl=", "ttl"},
      {"udpm://239.255.76.67:7667?tll=0", "tll"},
      {"udpm://239.255.76.67:7667?ttl", "\"ttl\""},
      {"udpm://239.255.76.67:7667?recv_buf_size=-1", "-1"},
      {"tcpq://localhost", "host:port"},
      {"tcpq://localhost:7700?ttl=1", "no options"},
      {"memq://here", "nothing"},
  };
  for (const auto& [url, part] : bad) {
    EXPECT_THAT(ErrorOf([&url = url] { ParseLcmUrl(url); }),
                AllOf(HasSubstr("\"" + url + "\""), HasSubstr(part), HasSubstr("udpm://239.255.76.67:7667")));
  }
}

}  // namespace
}  // namespace fresco
