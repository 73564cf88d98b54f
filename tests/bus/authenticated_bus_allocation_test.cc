// No heap use for a message that goes through an authenticated bus, once warm: every allocation of this
// program is counted.
#include <gtest/gtest.h>

#include <vector>

#include "bus/authenticated_bus.h"
#include "tests/support/allocation_count.h"

#ifndef FRESCO_SANITIZED

namespace fresco {
namespace {

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

}  // namespace
}  // namespace fresco

#endif
