#include "tests/actors/actor_fixture.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "core/bytes.h"
#include "msgs/weights_codec.h"
#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

template <class T>
void Append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

LearnerDouble::LearnerDouble(Bus& bus, const Channels& channels, const Experiment& experiment, int64_t run_id)
    : bus_(&bus), channels_(channels), experiment_(experiment), identity_{run_id, experiment.hash()} {
  bus.Subscribe(channels.transitions, [this](std::span<const std::byte> bytes) {
    transitions_t message;
    ASSERT_TRUE(Decode(bytes, message));
    if (IdentityOf(message) == identity_) {
      TakeTransitions(message);
    }
  });
  bus.Subscribe(channels.actor_status, [this](std::span<const std::byte> bytes) {
    ASSERT_TRUE(Decode(bytes, statuses_.emplace_back()));
  });
}

void LearnerDouble::TakeTransitions(const transitions_t& message) {
  OrderResult part;
  ASSERT_TRUE(FromWire(experiment_.world(), message, part));
  if (part.first_transition == 0) {
    open_ = part;
  } else {
    Episode& all = open_.episode;
    ASSERT_EQ(part.order_index, open_.order_index);
    ASSERT_EQ(part.first_transition, all.transitions());
    ASSERT_EQ(part.seed, open_.seed);
    const auto first_state = part.episode.states.begin();  // the last one of the part before
    part.episode.states.erase(first_state, first_state + experiment_.world().state_size());
    Append(part.episode.states, all.states);
    Append(part.episode.actions, all.actions);
    Append(part.episode.rewards, all.rewards);
    Append(part.td_errors, open_.td_errors);
    Append(part.episode.next_masks, all.next_masks);
    all.ending = part.episode.ending;
  }
  if (open_.episode.ending != Ending::kNone) {
    results_.push_back(open_);
    senders_.insert(message.actor_id);
  }
}

std::vector<run_t> LearnerDouble::RunParts() const {
  return Announcement(experiment_.Text(), 500);
}

void LearnerDouble::AnnounceRun(const std::function<void(run_t&)>& change) {
  for (run_t part : RunParts()) {
    Stamp(part, identity_, 1);
    change(part);
    Send(channels_.run, part, IdentityOf(part));
  }
}

void LearnerDouble::SendVersion(NetworkVersion version, const Vector& parameters,
                                const std::set<int>& without) {
  const auto values = Values(parameters);
  for (int chunk = 0; chunk < ChunkCount(parameters.size()); ++chunk) {
    if (!without.contains(chunk)) {
      Send(version.kind == NetworkKind::kCurrent ? channels_.weights_current : channels_.weights_target,
           WeightsChunk(values, Crc32c(values), version.number, chunk));
    }
  }
}

void LearnerDouble::SendOrders(const std::vector<order_t>& orders, int64_t committed) {
  orders_t message{};
  message.order_count = static_cast<int32_t>(orders.size());
  message.committed_orders = committed;
  message.orders = orders;
  Send(channels_.orders, message);
}

// Masks let episodes last: 59 transitions, two messages.
ActorTest::ActorTest(const ActorOptions& options)
    : experiment_(SmallField({{"scenario.slots", "60"},
                              {"scenario.initial_energy_j", "22000"},
                              {"agent.safe_action_mask", "true"},
                              {"agent.double_dqn", "true"},
                              {"schedule.window", "16"},
                              {"run.environments_per_actor", "5"}})),
      actor_(*bus_, channels_, WithClock(options)) {
  spdlog::set_level(spdlog::level::off);
}

ActorOptions ActorTest::OptionsOfTheActor() {
  ActorOptions options;
  options.actor_id = kActorId;
  options.host = "here";
  options.pid = 321;
  return options;
}

ActorOptions ActorTest::WithClock(ActorOptions options) const {
  options.clock_us = [this] { return now_us_; };
  options.wall_clock_us = [this] { return wall_us_; };
  options.available_memory = [this] { return available_memory_; };
  return options;
}

bool ActorTest::Step(int64_t later_us) {
  constexpr int kEverything = 100'000;
  bus_->Poll(0, kEverything);
  now_us_ += later_us;
  const bool busy = actor_.Step(now_us_);
  bus_->Poll(0, kEverything);
  return busy;
}

void ActorTest::FlyAll() {
  constexpr int kEndless = 5000;
  constexpr int kIdleSteps = 3;
  int idle_steps = 0;
  int steps = 0;
  while (idle_steps < kIdleSteps && ++steps < kEndless) {
    idle_steps = Step(10) ? 0 : idle_steps + 1;
  }
  ASSERT_LT(steps, kEndless);
}

void ActorTest::SendAndFly(const std::vector<order_t>& orders, int64_t committed) {
  learner_.SendOrders(orders, committed);
  FlyAll();
}

actor_status_t ActorTest::NextStatus() {
  constexpr int64_t kStatusPeriodUs = 100'000;
  const size_t before = learner_.statuses().size();
  Step(kStatusPeriodUs);
  EXPECT_EQ(learner_.statuses().size(), before + 1);
  return learner_.statuses().back();
}

void ActorTest::BeginRun() {
  learner_.AnnounceRun();
  Step();
  learner_.SendVersion({NetworkKind::kCurrent, 0}, *current_);
  learner_.SendVersion({NetworkKind::kTarget, 0}, *target_);
  Step();
  ASSERT_TRUE(actor_.has_run());
}

order_t ActorTest::OrderTo(int64_t actor_id, int64_t index, int32_t attempt) const {
  return ToWire(TrainOrder(index, kEpsilon), actor_id, attempt);
}

std::vector<order_t> ActorTest::Orders(int64_t first, int64_t count) const {
  std::vector<order_t> orders;
  for (int64_t index = first; index < first + count; ++index) {
    orders.push_back(OrderTo(kActorId, index));
  }
  return orders;
}

OrderResult ActorTest::Expected(int64_t index) const {
  return FlyAlone(experiment_, {TrainOrder(index, kEpsilon), current_, target_});
}

void ActorTest::ExpectEpisodes(size_t before, const std::vector<int64_t>& indices) const {
  std::vector<int64_t> arrived;
  for (size_t i = before; i < learner_.results().size(); ++i) {
    const OrderResult& result = learner_.results()[i];
    arrived.push_back(result.order_index);
    EXPECT_TRUE(SameBits(result, Expected(result.order_index))) << result.order_index;
  }
  std::sort(arrived.begin(), arrived.end());
  EXPECT_EQ(arrived, indices);
}

}  // namespace fresco
