// An actor and the learner's side on one in-process bus, driven by one thread.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "actors/actor.h"
#include "tests/msgs/message_samples.h"
#include "tests/training/acting_samples.h"

namespace fresco {

/// The learner's side of a bus, played by a test: publishes through the codecs of msgs/ and keeps what actors
/// answer. One thread.
class LearnerDouble {
 public:
  LearnerDouble(Bus& bus, const Channels& channels, const Experiment& experiment, int64_t run_id);

  /// The announcement's parts, changed by `change` (a lie, or the end of the run).
  void AnnounceRun(const std::function<void(run_t&)>& change = [](run_t&) {});
  std::vector<run_t> RunParts() const;
  void SendVersion(NetworkVersion version, const Vector& parameters, const std::set<int>& without = {});
  void SendOrders(const std::vector<order_t>& orders, int64_t committed = 0);

  /// Stamps with the run's identity, or another one, and publishes.
  template <class Message>
  void Send(const std::string& channel, Message message) {
    Send(channel, std::move(message), identity_);
  }
  template <class Message>
  void Send(const std::string& channel, Message message, RunIdentity identity) {
    Stamp(message, identity, utime_);
    bus_->Publish(channel, Encoded(message));
  }

  /// When the messages from now on were sent, by the learner's clock.
  void SetClock(int64_t utime) { utime_ = utime; }
  RunIdentity identity() const { return identity_; }
  /// Complete results of this run in the order of their arrival, and who sent them.
  const std::vector<OrderResult>& results() const { return results_; }
  const std::set<int64_t>& senders() const { return senders_; }
  /// Statuses of every run and of none.
  const std::vector<actor_status_t>& statuses() const { return statuses_; }

 private:
  void TakeTransitions(const transitions_t& message);

  Bus* bus_;
  Channels channels_;
  Experiment experiment_;
  RunIdentity identity_;
  int64_t utime_ = 1;
  OrderResult open_;  // the result whose parts are arriving
  std::vector<OrderResult> results_;
  std::set<int64_t> senders_;
  std::vector<actor_status_t> statuses_;
};

class ActorTest : public ::testing::Test {
 protected:
  explicit ActorTest(const ActorOptions& options = OptionsOfTheActor());

  static ActorOptions OptionsOfTheActor();
  ActorOptions WithClock(ActorOptions options) const;

  /// One step of the actor `later_us` after the one before, by the test's clock, and everything that is on
  /// the bus before and after it. Returns what the actor's step does.
  bool Step(int64_t later_us = 1000);

  /// Steps until the actor has had nothing to fly for some steps.
  void FlyAll();

  /// Sends these orders, and then FlyAll.
  void SendAndFly(const std::vector<order_t>& orders, int64_t committed = 0);

  /// The status that is sent after one more status period.
  actor_status_t NextStatus();

  /// Announces the run and has it served, with versions 0 of both networks.
  void BeginRun();

  order_t OrderTo(int64_t actor_id, int64_t index, int32_t attempt = 0) const;
  std::vector<order_t> Orders(int64_t first, int64_t count) const;

  /// The episode that an order, written by OrderTo, has to give.
  OrderResult Expected(int64_t index) const;
  /// Expects the learner to have got these orders' episodes since it had `before` of them, in any order.
  void ExpectEpisodes(size_t before, const std::vector<int64_t>& indices) const;

  static constexpr int64_t kActorId = 41;
  static constexpr int64_t kRunId = 0x7700000000000001;
  static constexpr double kEpsilon = 0.5;

  Channels channels_ = ChannelsWithPrefix("TEST");
  Experiment experiment_;
  SharedParameters current_ = SampleNetwork(experiment_, 1);
  SharedParameters target_ = SampleNetwork(experiment_, 2);
  std::unique_ptr<Bus> bus_ = OpenLcmBus("memq://");
  LearnerDouble learner_{*bus_, channels_, experiment_, kRunId};
  int64_t now_us_ = 0;
  int64_t wall_us_ = 0;               // stands still
  AvailableMemory available_memory_;  // no limit
  Actor actor_;
};

}  // namespace fresco
