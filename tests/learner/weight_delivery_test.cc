// Networks on their way from a publisher to stores over a network that loses chunks and requests, in
// simulated time: how soon a version is complete, and how much is sent for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <vector>

#include "actors/network_store.h"
#include "core/random.h"
#include "learner/weight_publisher.h"

namespace fresco {
namespace {

constexpr int64_t kStepUs = 100;
constexpr int64_t kBurstPeriodUs = 200;
constexpr int kChunksPerBurst = 8;
constexpr int64_t kTravelUs = 300;

struct Network {
  int actors = 1;
  double loss = 0;
  int parameters = 58'196;  // the paper's: 189 chunks
  int versions = 150;
  int64_t version_period_us = 60'000;
};

/// One publisher and some actors' stores, which no order names a version of.
class Simulation {
 public:
  explicit Simulation(const Network& network)
      : network_(network),
        parameters_(std::make_shared<const Vector>(Vector::Ones(network.parameters))),
        stores_(static_cast<size_t>(network.actors), NetworkStore(network.parameters)) {}

  void Run() {
    const int64_t end_us = network_.version_period_us * (network_.versions + 4);
    for (now_us_ = kStepUs; now_us_ < end_us; now_us_ += kStepUs) {
      Offer();
      Send();
      Deliver();
      Ask();
    }
  }

  /// How many versions every store has completed.
  int64_t least_completed() const {
    return std::min_element(
               stores_.begin(), stores_.end(),
               [](const auto& a, const auto& b) { return a.completed_versions() < b.completed_versions(); })
        ->completed_versions();
  }
  int64_t longest_us() const {
    int64_t longest = 0;
    for (const NetworkStore& store : stores_) {
      longest = std::max(longest, store.longest_assembly_us());
    }
    return longest;
  }
  double traffic() const {
    return static_cast<double>(publisher_.sent_chunks()) /
           (static_cast<double>(network_.versions) * ChunkCount(network_.parameters));
  }

 private:
  struct InFlight {
    int64_t arrives_us;
    size_t store;  // to it, or from it
    NetworkKind kind;
    weights_t chunk;
    std::vector<chunk_range_t> missing;
  };

  bool IsLost() { return stream_.NextUniform() < network_.loss; }

  void Offer() {
    if (now_us_ % network_.version_period_us == 0 && offered_ < network_.versions) {
      const NetworkKind kind = offered_ % 3 == 2 ? NetworkKind::kTarget : NetworkKind::kCurrent;
      publisher_.Offer({kind, next_version_[kind]++}, parameters_);
      publisher_.Retain(next_version_[NetworkKind::kCurrent] - 4, next_version_[NetworkKind::kTarget] - 4);
      ++offered_;
    }
  }

  void Send() {
    for (int i = 0; now_us_ % kBurstPeriodUs == 0 && i < kChunksPerBurst; ++i) {
      const auto next = publisher_.Next(now_us_);
      for (size_t store = 0; next && store < stores_.size(); ++store) {
        if (!IsLost()) {
          chunks_.push_back({now_us_ + kTravelUs, store, next->first, next->second, {}});
        }
      }
    }
  }

  void Deliver() {
    for (; !chunks_.empty() && chunks_.front().arrives_us <= now_us_; chunks_.pop_front()) {
      const InFlight& arrived = chunks_.front();
      stores_[arrived.store].Add(arrived.kind, arrived.chunk, now_us_);
    }
    for (; !requests_.empty() && requests_.front().arrives_us <= now_us_; requests_.pop_front()) {
      for (const chunk_range_t& range : requests_.front().missing) {
        publisher_.Request(range, now_us_);
      }
    }
  }

  void Ask() {
    for (size_t store = 0; store < stores_.size(); ++store) {
      if ((now_us_ + static_cast<int64_t>(store) * 1300) % kChunkRequestPeriodUs != 0) {
        continue;
      }
      auto missing = stores_[store].MissingRanges(now_us_);
      if (!missing.empty() && !IsLost()) {
        requests_.push_back({now_us_ + kTravelUs, store, NetworkKind::kCurrent, {}, std::move(missing)});
      }
    }
  }

  Network network_;
  std::shared_ptr<const Vector> parameters_;
  WeightPublisher publisher_;
  std::vector<NetworkStore> stores_;
  RandomStream stream_{1, RandomPurpose::kTest, 5, 0};
  std::map<NetworkKind, int32_t> next_version_;
  int offered_ = 0;
  int64_t now_us_ = 0;
  std::deque<InFlight> chunks_;
  std::deque<InFlight> requests_;
};

void ExpectDelivery(const Network& network, double most_traffic, int64_t longest_us = 100'000) {
  Simulation simulation(network);
  simulation.Run();
  EXPECT_EQ(simulation.least_completed(), network.versions);
  EXPECT_LT(simulation.longest_us(), longest_us);
  EXPECT_LT(simulation.traffic(), most_traffic);
}

TEST(WeightDelivery, SendsEveryChunkOnceWhereNothingIsLost) {
  Simulation simulation({.actors = 3, .loss = 0, .versions = 20});
  simulation.Run();
  EXPECT_EQ(simulation.least_completed(), 20);
  EXPECT_EQ(simulation.traffic(), 1);
  EXPECT_LT(simulation.longest_us(), 10'000);
}

TEST(WeightDelivery, CompletesEveryVersionWithin100MillisecondsAtFivePercentLossWithAFifthMoreTrafficAtMost) {
  ExpectDelivery({.actors = 1, .loss = 0.05}, 1.1);
  ExpectDelivery({.actors = 3, .loss = 0.05}, 1.2);
}

TEST(WeightDelivery,
     CompletesEveryVersionWithin100MillisecondsAtOnePercentLossWithAFiftiethMoreTrafficAtMost) {
  ExpectDelivery({.actors = 1, .loss = 0.01}, 1.02);
  ExpectDelivery({.actors = 3, .loss = 0.01}, 1.05);
}

TEST(WeightDelivery, SendsAgainTheUnionOfWhatTwentyActorsLack) {
  // Each chunk is lost to somebody with 1 - 0.95^20 = 64 %: that much, not twenty times.
  ExpectDelivery({.actors = 20, .loss = 0.05, .parameters = 5'000, .versions = 40}, 2.2);
}

}  // namespace
}  // namespace fresco
