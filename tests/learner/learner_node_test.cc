// What the learner's side of the bus says of itself, on an in-process bus.
#include "learner/learner_node.h"

#include <gtest/gtest.h>

#include <spdlog/spdlog.h>
#include <cmath>

#include "core/clock.h"
#include "msgs/protocol_times.h"
#include "msgs/world_messages.h"
#include "nn/mlp.h"
#include "tests/msgs/message_samples.h"
#include "tests/training/literal_run.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

constexpr int64_t kRunId = 0x2a;

class LearnerNodeTest : public ::testing::Test {
 protected:
  LearnerNodeTest() : experiment_(SmallExperiment()) {
    spdlog::set_level(spdlog::level::err);
    bus_->Subscribe(channels_.learner_status,
                    [this](std::span<const std::byte> bytes) { ASSERT_TRUE(Decode(bytes, status_)); });
  }

  /// Steps until a status sent after this moment has arrived.
  const learner_status_t& NextStatus() {
    const int64_t now = WallMicroseconds();
    while (status_.utime < now) {
      node_.Step();
    }
    return status_;
  }

  void SendStatus(int64_t actor_id, int64_t sequence) {
    actor_status_t status{};
    Stamp(status, {kRunId, experiment_.hash()}, 1);
    status.actor_id = actor_id;
    status.sequence = sequence;
    status.capacity = 4;
    status.pid = 12;
    status.host = "there";
    status.oldest_open_order = -1;
    status.arithmetic_fingerprint = ArithmeticFingerprint();
    bus_->Publish(channels_.actor_status, Encoded(status));
  }

  Experiment experiment_;
  Channels channels_ = ChannelsWithPrefix("TEST");
  std::unique_ptr<Bus> bus_ = OpenLcmBus("memq://");
  LearnerNode node_{experiment_, kRunId, *bus_, channels_};
  learner_status_t status_{};
};

TEST_F(LearnerNodeTest, ShowsAWarningInItsStatusUntilItIsTakenBack) {
  EXPECT_EQ(NextStatus().warning, "");
  node_.Report({.warning = "the last checkpoint could not be written: no space"});
  EXPECT_EQ(NextStatus().warning, "the last checkpoint could not be written: no space");
  node_.Report({.warning = std::string(5000, 'w')});
  EXPECT_EQ(NextStatus().warning, std::string(kMaximumWarningBytes, 'w'));
  node_.Report({});
  EXPECT_EQ(NextStatus().warning, "");
}

TEST_F(LearnerNodeTest, TellsAGapOnlyToAProvedOptimum) {
  Evaluation evaluation;
  evaluation.success = 1;
  evaluation.figures = {12, 1000, 3};
  evaluation.scores = {12};
  TrainingReport report{.last_evaluation = evaluation, .best = BestNetwork{evaluation, nullptr}};
  report.optimum = {{2, false}};
  node_.Report(report);
  learner_status_t status = NextStatus();
  EXPECT_EQ(status.score, 12);
  EXPECT_EQ(status.success, 1);
  EXPECT_EQ(status.best_score, 12);
  EXPECT_EQ(status.score_bound, 2);
  EXPECT_EQ(status.optimum_proved, 0);
  EXPECT_TRUE(std::isnan(status.gap_percent));
  report.optimum = {{10, true}};
  node_.Report(report);
  status = NextStatus();
  EXPECT_EQ(status.optimum_proved, 1);
  EXPECT_EQ(status.gap_percent, 20);
  EXPECT_EQ(status.gap_median_percent, 20);
  EXPECT_EQ(status.gap_worst_percent, 20);
}

TEST_F(LearnerNodeTest, TellsTheGapsOfSeveralEpisodes) {
  Evaluation evaluation;
  evaluation.success = 1;
  evaluation.figures = {11.5, 1000, 3};
  evaluation.scores = {11, 10, 9, 16};
  TrainingReport report{.last_evaluation = evaluation, .best = BestNetwork{evaluation, nullptr}};
  report.optimum = {{10, true}, {10, true}, {9, true}, {8, false}, {1, true}};
  node_.Report(report);
  learner_status_t status = NextStatus();
  EXPECT_EQ(status.score_bound, 9.25);
  EXPECT_EQ(status.optimum_proved, 0);
  EXPECT_TRUE(std::isnan(status.gap_percent));
  report.optimum[3].proved = true;
  node_.Report(report);
  status = NextStatus();
  EXPECT_EQ(status.optimum_proved, 1);
  EXPECT_EQ(status.gap_percent, 27.5);  // 10, 0, 0 and 100 percent
  EXPECT_EQ(status.gap_median_percent, 5);
  EXPECT_EQ(status.gap_worst_percent, 100);
}

TEST_F(LearnerNodeTest, TellsViewersItsField) {
  scenario_t field{};
  bus_->Subscribe(channels_.scenario,
                  [&](std::span<const std::byte> bytes) { ASSERT_TRUE(Decode(bytes, field)); });
  NextStatus();
  EXPECT_EQ(IdentityOf(field), (RunIdentity{kRunId, experiment_.hash()}));
  const UavWorld& world = RequireUavWorld(experiment_.world(), "the test");
  EXPECT_EQ(field.slots, world.scenario().slots);
  ASSERT_EQ(field.sensor_count, world.sensors());
  EXPECT_EQ(field.x_m[0], world.scenario().sensors[0].x_m);
}

TEST_F(LearnerNodeTest, TellsViewersTheNamesOfItsWorld) {
  WorldNamesReader reader;
  bus_->Subscribe(channels_.world, [&](std::span<const std::byte> bytes) {
    world_t message{};
    ASSERT_TRUE(Decode(bytes, message));
    EXPECT_EQ(IdentityOf(message), (RunIdentity{kRunId, experiment_.hash()}));
    reader.Add(message);
  });
  NextStatus();
  const WorldNames* names = reader.names();
  ASSERT_NE(names, nullptr);
  EXPECT_EQ(names->world, "uav");
  ASSERT_EQ(names->state.size(), 6u);  // cell, margins and two sensors
  EXPECT_EQ(names->state[kEnergyMarginField].unit, "J");
  EXPECT_EQ(names->actions.size(), 15u);
  EXPECT_TRUE(names->less_is_better);
}

TEST(LearnerNodeInCartPole, TellsViewersNoField) {
  const Experiment experiment = SmallCartPole();
  const Channels channels = ChannelsWithPrefix("TEST");
  const auto bus = OpenLcmBus("memq://");
  int fields = 0;
  int worlds = 0;
  bus->Subscribe(channels.scenario, [&](std::span<const std::byte>) { ++fields; });
  bus->Subscribe(channels.world, [&](std::span<const std::byte>) { ++worlds; });
  LearnerNode node(experiment, kRunId, *bus, channels);
  node.Step();
  while (bus->Poll(0) > 0) {
  }
  EXPECT_EQ(fields, 0);
  EXPECT_EQ(worlds, 1);
}

TEST_F(LearnerNodeTest, CountsTheAnnouncementsOfOtherRunsOnly) {
  NextStatus();  // after its own
  EXPECT_EQ(node_.counters().rejected, 0);
  EXPECT_EQ(node_.foreign_run(), 0);
  for (const int64_t run_id : {kRunId + 1, kRunId + 2}) {
    run_t other{};
    other.run_id = run_id;
    other.utime = WallMicroseconds();
    bus_->Publish(channels_.run, Encoded(other));
    NextStatus();
    EXPECT_EQ(node_.foreign_run(), run_id);
  }
  EXPECT_EQ(node_.counters().rejected_foreign, 2);
  EXPECT_EQ(node_.counters().rejected, 2);
}

TEST_F(LearnerNodeTest, TakesAnAnnouncementThatIsNotOfNowForNoRunThatGoesOn) {
  constexpr int64_t kSecondUs = 1'000'000;
  for (const int64_t run_id : {kRunId, kRunId + 1}) {  // its own of before it was resumed, another's
    for (const int64_t later_us : {-kClockToleranceUs - kSecondUs, kClockToleranceUs + kSecondUs}) {
      run_t recorded{};
      recorded.run_id = run_id;
      recorded.utime = WallMicroseconds() + later_us;
      bus_->Publish(channels_.run, Encoded(recorded));
    }
  }
  EXPECT_EQ(bus_->Poll(1'000'000), 4);
  EXPECT_EQ(node_.counters().rejected_foreign, 4);
  EXPECT_EQ(node_.foreign_run(), 0);
}

TEST_F(LearnerNodeTest, CountsHowLongTheTrainerHasWaited) {
  EXPECT_EQ(node_.StarvedSeconds(), 0);
  node_.WriteOrder(Order{});
  EXPECT_EQ(node_.WaitingFor(), "");
  EXPECT_FALSE(node_.WaitForNext(0));
  EXPECT_EQ(node_.WaitingFor(), "an actor to join");
  while (node_.StarvedSeconds() < 0.01) {
    node_.Step();
    EXPECT_FALSE(node_.WaitForNext(0));
  }
  node_.Report({.finishing = "the optimum"});
  EXPECT_EQ(node_.StarvedSeconds(), 0);
  EXPECT_EQ(node_.WaitingFor(), "the optimum");
}

TEST_F(LearnerNodeTest, IgnoresStatusesThatComeAgain) {
  for (const int64_t sequence : {3, 3, 2, 4, 4}) {
    SendStatus(7, sequence);
  }
  NextStatus();  // in which they have been polled
  EXPECT_EQ(NextStatus().actors, 1);
  EXPECT_EQ(node_.counters().stale_statuses, 3);
  EXPECT_EQ(node_.counters().received, 5);
  EXPECT_EQ(node_.counters().rejected, 0);
}

TEST_F(LearnerNodeTest, CountsTheChunksOfNetworksThatItSends) {
  const auto parameters = std::make_shared<const Vector>(experiment_.network()->InitialParameters(1));
  node_.OfferVersion({NetworkKind::kCurrent, 0}, parameters);
  NextStatus();
  EXPECT_EQ(node_.counters().weights_chunks_sent, ChunkCount(parameters->size()));
  EXPECT_EQ(node_.counters().weights_chunks_repeated, 0);
}

TEST_F(LearnerNodeTest, TellsItsState) {
  node_.WriteOrder(Order{});
  EXPECT_FALSE(node_.WaitForNext(0));
  node_.OfferVersion({NetworkKind::kTarget, 5},
                     std::make_shared<const Vector>(experiment_.network()->InitialParameters(1)));
  node_.Report({.warning = "the disk is full"});
  SendStatus(7, 0);
  NextStatus();
  NextStatus();
  const std::string text = node_.StateText();
  for (const char* part :
       {"run 000000000000002a", "0 orders committed, 1 in flight", "waits for there (pid 12): order 0 for ",
        "starved for ", "warning: the disk is full", "networks on offer: target 5", "1 received",
        "\n  1 actors\n  actor 0000000000000007 there (pid 12): heard of ", "orders 0"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

}  // namespace
}  // namespace fresco
