// An actor asks for no memory once it is warm: it flies, cuts episodes into messages and encodes them.
#include <gtest/gtest.h>

#include <array>

#include "tests/support/allocation_count.h"
#include "tests/support/sanitized.h"
#include "tests/training/acting_samples.h"
#include "tests/training/literal_run.h"

namespace fresco {
namespace {

/// Flies many orders, a few at a time, and sends their results to nobody. Always the same orders.
class ActorLoop {
 public:
  explicit ActorLoop(const Experiment& experiment)
      : experiment_(experiment),
        flyer_(experiment, kEnvironments),
        networks_{SampleNetwork(experiment, 1), SampleNetwork(experiment, 2)} {}

  void FlyAll() {
    for (int64_t index = 0; index < kOrders || !flyer_.Idle();) {
      for (; index < kOrders && flyer_.HasRoom(); ++index) {
        Order order = TrainOrder(index, 0.5);
        order.seed = static_cast<uint64_t>(100 + index);
        order.current_version = static_cast<int32_t>(index % 3);  // several groups at a time
        flyer_.Start(order, networks_[static_cast<size_t>(index % 2)], networks_[1]);
      }
      flyer_.Step([this](const Order&, const OrderResult& result) { Send(result); });
    }
  }

  int64_t sent_bytes() const { return sent_bytes_; }

 private:
  static constexpr int kEnvironments = 7;
  static constexpr int64_t kOrders = 60;

  void Send(const OrderResult& result) {
    SplitResult(experiment_.world(), result, 1, [this](const transitions_t& message) {
      Encode(message, bytes_);
      sent_bytes_ += static_cast<int64_t>(bytes_.size());
    });
  }

  Experiment experiment_;
  Flyer flyer_;
  std::array<SharedParameters, 2> networks_;
  std::vector<std::byte> bytes_;
  int64_t sent_bytes_ = 0;
};

void ExpectNoAllocations(const Experiment& experiment) {
  if (kSanitized) {
    GTEST_SKIP() << "a sanitizer allocates for itself";
  }
  ActorLoop loop(experiment);
  loop.FlyAll();
  const int64_t bytes = loop.sent_bytes();
  const int64_t before = AllocationCount();
  loop.FlyAll();
  EXPECT_EQ(AllocationCount(), before);
  EXPECT_EQ(loop.sent_bytes(), 2 * bytes);
  EXPECT_GT(bytes, 10'000);
}

TEST(ActingAllocations, ThereAreNoneInTheFieldOnceWarm) {
  ExpectNoAllocations(SmallField(WithMasks()));
}

TEST(ActingAllocations, ThereAreNoneWithANetworkForSetsOnceWarm) {
  ExpectNoAllocations(SmallSetExperiment());
}

TEST(ActingAllocations, ThereAreNoneInCartPoleOnceWarm) {
  ExpectNoAllocations(SmallCartPole());
}

}  // namespace
}  // namespace fresco
