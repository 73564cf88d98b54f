// An actor and the learner's side on one in-process bus, driven by one thread.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "actors/actor.h"
#include "tests/actors/learner_double.h"

namespace fresco {

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
  World world_{experiment_.scenario()};
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
