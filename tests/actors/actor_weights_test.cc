// How an actor comes by the networks that its orders name.
#include "tests/actors/actor_fixture.h"
#include "tests/actors/store_samples.h"

namespace fresco {
namespace {

class ActorWeights : public ActorTest {
 protected:
  static constexpr NetworkVersion kCurrent4{NetworkKind::kCurrent, 4};
  static constexpr NetworkVersion kTarget3{NetworkKind::kTarget, 3};

  /// An order that names current 4 and target 3.
  order_t Newer(int64_t index) const {
    order_t order = OrderTo(kActorId, index);
    order.current_version = kCurrent4.number;
    order.target_version = kTarget3.number;
    return order;
  }

  int chunks() const { return ChunkCount(current_->size()); }
};

TEST_F(ActorWeights, AreWaitedForUntilBothNetworksAreComplete) {
  BeginRun();
  learner_.SendOrders({Newer(0)});
  learner_.SendVersion(kTarget3, *target_);
  learner_.SendVersion(kCurrent4, *current_, {2});
  FlyAll();
  EXPECT_TRUE(learner_.results().empty());
  learner_.SendVersion(kCurrent4, *current_, {0, 1});
  FlyAll();
  ExpectEpisodes(0, {0});
}

TEST_F(ActorWeights, OfAnOrderMayArriveBeforeIt) {
  BeginRun();
  learner_.SendVersion(kCurrent4, *current_);
  learner_.SendVersion(kTarget3, *target_);
  EXPECT_EQ(Plain(NextStatus().held),
            (Ranges{{1, 3, 0, chunks()}, {1, 0, 0, chunks()}, {0, 4, 0, chunks()}, {0, 0, 0, chunks()}}));
  SendAndFly({Newer(0)});
  ExpectEpisodes(0, {0});
}

TEST_F(ActorWeights, ThatAreMissingAreAskedForByTheirChunks) {
  BeginRun();
  learner_.SendOrders({Newer(0)});
  learner_.SendVersion(kCurrent4, *current_, {0, 3, 4, chunks() - 1});
  Step(10'000);  // its requests are not more frequent; since now target 3 is missed
  const Ranges gaps = {{0, 4, 0, 1}, {0, 4, 3, 2}, {0, 4, chunks() - 1, 1}, {1, 3, 0, chunks()}};
  EXPECT_EQ(Plain(NextStatus().missing), gaps);
  learner_.SendVersion(kTarget3, *target_, {5});
  Step();
  EXPECT_EQ(Plain(NextStatus().missing),
            (Ranges{{0, 4, 0, 1}, {0, 4, 3, 2}, {0, 4, chunks() - 1, 1}, {1, 3, 5, 1}}));
  learner_.SendVersion(kCurrent4, *current_);
  learner_.SendVersion(kTarget3, *target_);
  FlyAll();
  ExpectEpisodes(0, {0});
  EXPECT_EQ(NextStatus().missing_count, 0);
}

TEST_F(ActorWeights, ThatAreMissingAreAskedForMoreOftenThanAStatusIsDue) {
  BeginRun();
  NextStatus();
  learner_.SendOrders({Newer(0)});
  const size_t before = learner_.statuses().size();
  for (int i = 0; i < 9; ++i) {
    Step(10'000);
  }
  EXPECT_GE(learner_.statuses().size() - before, 6u);
  EXPECT_EQ(learner_.statuses().back().missing_count, 2);
}

TEST_F(ActorWeights, ThatAreOnTheirWayAreAskedForBeforeAnOrderNamesThemButNotForEver) {
  BeginRun();
  learner_.SendVersion(kCurrent4, *current_, {1});
  Step();
  EXPECT_EQ(Plain(NextStatus().missing), (Ranges{{0, 4, 1, 1}}));
  for (int i = 0; i < 50; ++i) {
    Step(10'000);
  }
  const size_t before = learner_.statuses().size();
  for (int i = 0; i < 100; ++i) {
    Step(10'000);
  }
  EXPECT_LE(learner_.statuses().size() - before, 11u);  // no more often than a status is due
  EXPECT_EQ(learner_.statuses().back().missing_count, 0);
}

TEST_F(ActorWeights, ThatTookLongToArriveAreReportedWithTheirTime) {
  BeginRun();
  EXPECT_EQ(NextStatus().weights_latency_ms, 0);
  learner_.SendVersion(kCurrent4, *current_, {1});
  Step(2'000);
  Step(20'000);
  learner_.SendVersion(kCurrent4, *current_);
  Step(1'000);
  EXPECT_FLOAT_EQ(NextStatus().weights_latency_ms, 22);
  EXPECT_NE(actor_.Description().find("3 versions completed, the slowest within 22.0 ms"), std::string::npos)
      << actor_.Description();
}

TEST_F(ActorWeights, OfAnotherRunAreCountedAndIgnored) {
  BeginRun();
  learner_.SendOrders({Newer(0)});
  const std::span<const float> values = Values(*target_);
  for (int chunk = 0; chunk < chunks(); ++chunk) {
    const weights_t message = WeightsChunk(values, Crc32c(values), 4, chunk);
    learner_.Send(channels_.weights_current, message, {kRunId + 1, learner_.identity().config_hash});
    learner_.Send(channels_.weights_current, message, {kRunId, learner_.identity().config_hash ^ 1});
  }
  Step();
  EXPECT_EQ(NextStatus().rejected_messages, 2 * chunks());
  learner_.SendVersion(kCurrent4, *current_);
  learner_.SendVersion(kTarget3, *target_);
  FlyAll();
  ExpectEpisodes(0, {0});
}

TEST_F(ActorWeights, WhoseCrcDoesNotHoldAreNeverFlownWith) {
  BeginRun();
  learner_.SendOrders({Newer(0)});
  learner_.SendVersion(kTarget3, *target_);
  std::vector<float> values(current_->begin(), current_->end());
  const uint32_t crc = Crc32c(values);
  values[700] += 1;
  for (int chunk = 0; chunk < chunks(); ++chunk) {
    learner_.Send(channels_.weights_current, WeightsChunk(values, crc, 4, chunk));
  }
  FlyAll();
  EXPECT_TRUE(learner_.results().empty());
  EXPECT_EQ(actor_.totals().rejected.total(), 1);
  NextStatus();
  EXPECT_EQ(Plain(NextStatus().missing), (Ranges{{0, 4, 0, chunks()}}));
  learner_.SendVersion(kCurrent4, *current_);
  FlyAll();
  ExpectEpisodes(0, {0});
}

}  // namespace
}  // namespace fresco
