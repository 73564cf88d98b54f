// Runs that an actor can't serve, and messages that are not what they should be.
#include <cmath>
#include <functional>
#include <limits>

#include "bus/authenticated_bus.h"
#include "core/random.h"
#include "tests/actors/actor_fixture.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

using ActorBadInput = ActorTest;

struct Lie {
  const char* name;
  std::function<void(run_t&)> tell;
};

class ActorRefusal : public ActorTest, public ::testing::WithParamInterface<Lie> {};

TEST_P(ActorRefusal, OfARunThatItCantServeLeavesItFreeForAnother) {
  for (int i = 0; i < 3; ++i) {
    learner_.AnnounceRun(GetParam().tell);
    Step();
  }
  EXPECT_FALSE(actor_.has_run());
  EXPECT_EQ(NextStatus().run_id, 0);
  EXPECT_EQ(actor_.totals().runs, 0);
  LearnerDouble other(*bus_, channels_, experiment_, kRunId + 1);
  other.AnnounceRun();
  EXPECT_EQ(NextStatus().run_id, kRunId + 1);
}

INSTANTIATE_TEST_SUITE_P(
    Lies, ActorRefusal,
    ::testing::Values(Lie{"NewerProtocol", [](run_t& part) { part.protocol_version = kProtocolVersion + 1; }},
                      Lie{"OlderProtocol", [](run_t& part) { part.protocol_version = kProtocolVersion - 1; }},
                      Lie{"OtherArithmetic", [](run_t& part) { part.arithmetic_fingerprint ^= 1; }},
                      Lie{"WrongHash", [](run_t& part) { part.config_hash ^= 1; }},
                      Lie{"NoHash", [](run_t& part) { part.config_hash = 0; }},
                      Lie{"ChangedConfiguration",  // "slots: 60" becomes "slots: 61"
                          [](run_t& part) {
                            const std::string text(part.part.begin(), part.part.end());
                            if (const size_t at = text.find("slots: 60"); at != std::string::npos) {
                              part.part[at + 8] = '1';
                            }
                          }},
                      Lie{"NotAConfiguration", [](run_t& part) { part.part.assign(part.part.size(), '{'); }},
                      Lie{"NoRunId", [](run_t& part) { part.run_id = 0; }}),
    [](const auto& instance) { return instance.param.name; });

TEST_F(ActorBadInput, OfARunForWhichThereIsNoMemoryLeavesItFreeForAnother) {
  available_memory_.process = {1'000'000, "what this test allows"};
  learner_.AnnounceRun();
  Step();
  EXPECT_FALSE(actor_.has_run());
  available_memory_ = {};
  LearnerDouble other(*bus_, channels_, experiment_, kRunId + 1);
  other.AnnounceRun();
  EXPECT_EQ(NextStatus().run_id, kRunId + 1);
}

TEST_F(ActorBadInput, IsCountedAndHarmlessWhereBytesAreMalformed) {
  BeginRun();
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  int64_t sent = 0;
  const auto send = [&](const std::vector<std::byte>& bytes) {
    for (const std::string& channel :
         {channels_.run, channels_.orders, channels_.weights_current, channels_.weights_target}) {
      bus_->Publish(channel, bytes);
      ++sent;
    }
  };
  for (const size_t size : {1, 4, 8, 40, 1350, 1351, 5000}) {
    std::vector<std::byte> rubbish(size);
    for (std::byte& byte : rubbish) {
      byte = static_cast<std::byte>(stream.NextBelow(256));
    }
    send(rubbish);
    send(std::vector<std::byte>(size));
  }
  send(Encoded(ActorStatusOf(stream, 2, 2, 5)));  // sound, but of another type
  auto torn = Encoded(OrdersOf(stream, 3));
  torn.pop_back();
  send(torn);
  auto flipped = Encoded(WeightsOf(stream, 100));
  flipped[60] ^= std::byte{4};
  send(flipped);
  EXPECT_EQ(NextStatus().rejected_messages, sent);
  EXPECT_EQ(actor_.totals().rejected.malformed, sent);
  SendAndFly(Orders(0, 2));
  ExpectEpisodes(0, {0, 1});
}

TEST_F(ActorBadInput, IsCountedAndHarmlessWhereSoundMessagesAreOfRandomContent) {
  BeginRun();
  RandomStream stream(2, RandomPurpose::kTest, 0, 0);
  constexpr int kRounds = 50;
  for (int round = 0; round < kRounds; ++round) {
    bus_->Publish(channels_.run, Encoded(RandomMessage<run_t>(stream)));
    bus_->Publish(channels_.orders, Encoded(RandomMessage<orders_t>(stream)));
    bus_->Publish(channels_.weights_current, Encoded(RandomMessage<weights_t>(stream)));
    learner_.Send(channels_.weights_target, RandomMessage<weights_t>(stream));  // of this run
  }
  Step();
  EXPECT_EQ(actor_.totals().rejected.total(), 4 * kRounds);
  SendAndFly(Orders(0, 2));
  ExpectEpisodes(0, {0, 1});
}

TEST_F(ActorBadInput, IsCountedWhereItWasMadeWithoutTheActorsKey) {
  const std::vector<std::byte> secret(32, std::byte{1});
  const auto keyed = MakeAuthenticatedBus(*bus_, AuthenticationKey(secret));
  ActorOptions options = OptionsOfTheActor();
  options.actor_id = kActorId + 1;
  Actor actor(*keyed, channels_, options);
  learner_.AnnounceRun();
  Step();
  EXPECT_TRUE(actor_.has_run());
  EXPECT_FALSE(actor.has_run());
  EXPECT_EQ(actor.totals().rejected.unauthenticated, static_cast<int64_t>(learner_.RunParts().size()));
}

TEST_F(ActorBadInput, IsCountedAndHarmlessWhereOrdersAreOutOfRange) {
  BeginRun();
  const std::vector<std::function<void(order_t&)>> lies = {
      [](order_t& order) { order.epsilon = 1.5; },
      [](order_t& order) { order.epsilon = -0.1; },
      [](order_t& order) { order.epsilon = std::numeric_limits<double>::quiet_NaN(); },
      [](order_t& order) { order.index = int64_t{1} << 32; },
      [](order_t& order) { order.kind = 2; },
      [](order_t& order) { order.current_version = -1; },
      [](order_t& order) { order.target_version = -1; },
      [](order_t& order) { order.attempt = -1; },
  };
  std::vector<order_t> orders = Orders(0, 1);
  for (const auto& lie : lies) {
    orders.push_back(OrderTo(kActorId, 3));
    lie(orders.back());
  }
  orders.push_back(OrderTo(kActorId, 4));
  SendAndFly(orders);
  EXPECT_EQ(actor_.totals().rejected.inconsistent, static_cast<int64_t>(lies.size()));
  ExpectEpisodes(0, {0, 4});
}

}  // namespace
}  // namespace fresco
