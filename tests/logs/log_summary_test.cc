// What `fresco log info` shows of messages that were made by hand.
#include "logs/log_summary.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "msgs/world_messages.h"
#include "tests/msgs/message_samples.h"
#include "tests/worlds/table_one.h"
#include "worlds/uav/uav_world.h"

namespace fresco {
namespace {

constexpr RunIdentity kRun = {0x123456789abcdef0, 0xcafe0001};

class Log {
 public:
  template <class Message>
  void Add(const std::string& channel, const Message& message) {
    AddBytes(channel, Encoded(message));
  }
  void AddBytes(const std::string& channel, const std::vector<std::byte>& bytes) {
    summary.Take({0, utime, channel, bytes});
    utime += 500'000;
  }
  nlohmann::json Json() const { return nlohmann::json::parse(LogSummaryJson(summary, {1000, 7, 0})); }

  LogSummary summary;
  int64_t utime = 1'700'000'000'000'000;
};

transitions_t Transitions(int64_t order, int32_t first, int count, int8_t ending) {
  RandomStream stream(9, RandomPurpose::kTest, 0, 0);
  transitions_t message = TransitionsOf(stream, count, 7, 20);
  Stamp(message, kRun, 1);
  message.order_index = order;
  message.first_transition = first;
  message.first_field = 0;
  message.ending = ending;
  message.actor_id = 77;
  return message;
}

run_t RunMessage(int32_t part, int8_t finished) {
  RandomStream stream(9, RandomPurpose::kTest, 1, 0);
  run_t message = RunOf(stream, 10);
  Stamp(message, kRun, 1);
  message.part_index = part;
  message.part_count = 2;
  message.finished = finished;
  return message;
}

actor_status_t Status(int64_t sequence) {
  RandomStream stream(9, RandomPurpose::kTest, 2, 0);
  actor_status_t message = ActorStatusOf(stream, 1, 2, 5);
  Stamp(message, kRun, 1);
  message.actor_id = 77;
  message.sequence = sequence;
  return message;
}

TEST(LogSummary, TellsRunsEpisodesAndActors) {
  Log log;
  log.Add("FRESCO_RUN", RunMessage(0, 0));
  log.Add("FRESCO_TRANSITIONS", Transitions(0, 0, 4, 0));
  log.Add("FRESCO_TRANSITIONS", Transitions(0, 4, 2, 1));
  log.Add("FRESCO_TRANSITIONS", Transitions(0, 4, 2, 1));
  log.Add("FRESCO_TRANSITIONS", Transitions(3, 4, 2, 1));
  EXPECT_FALSE(log.summary.runs().at(kRun.run_id).config_known);
  log.Add("FRESCO_RUN", RunMessage(1, 1));
  for (const int64_t sequence : {5, 6, 9, 10}) {
    log.Add("FRESCO_ACTOR_STATUS", Status(sequence));
  }
  const auto json = log.Json();
  const auto& run = json["runs"][0];
  EXPECT_EQ(run["run_id"], "123456789abcdef0");
  EXPECT_EQ(run["config_hash"], "cafe0001");
  EXPECT_EQ(run["config_known"], true);
  EXPECT_EQ(run["finished"], true);
  EXPECT_EQ(run["episodes_whole"], 1);
  EXPECT_EQ(run["episodes_partial"], 1);
  EXPECT_EQ(run["orders_without_transitions"], 2);  // 1 and 2
  EXPECT_EQ(run["transitions"], 8);
  EXPECT_EQ(run["transitions_missing"], 4);
  EXPECT_EQ(run["transitions_repeated"], 2);
  EXPECT_EQ(run["actors"], nlohmann::json::array({77}));
  const auto& actor = json["actors"][0];
  EXPECT_EQ(actor["statuses"], 4);
  EXPECT_EQ(actor["missing"], 2);
  EXPECT_EQ(actor["first_gaps"], nlohmann::json::parse("[[7, 8]]"));
  EXPECT_EQ(json["duration_s"], 4.5);
  EXPECT_EQ(json["damaged_bytes"], 7);
  EXPECT_NE(LogSummaryText(log.summary, {}).find("1 whole, 1 partial"), std::string::npos);
}

/// A UAV's field of 250 sensors: a state of 254 values, in several messages.
class WideRun {
 public:
  WideRun() : world_(Field()) {
    RandomStream stream(9, RandomPurpose::kTest, 3, 0);
    for (int64_t index = 0; index < 2; ++index) {
      Order order;
      order.index = index;
      const OrderResult result = RandomResult(world_, order, stream);
      transitions += result.episode.transitions();
      SplitResult(world_, result, 77, [&](transitions_t message) {
        Stamp(message, kRun, 1);
        messages.push_back(message);
      });
    }
  }
  world_t Names() const {
    world_t names = WorldMessages(world_).front();
    Stamp(names, kRun, 1);
    return names;
  }

  std::vector<transitions_t> messages;
  int64_t transitions = 0;

 private:
  static Scenario Field() {
    Scenario scenario = TableOne();
    scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, 250, 1);
    return scenario;
  }

  UavWorld world_;
};

TEST(LogSummary, CountsAStateThatIsInSeveralMessagesOnce) {
  const WideRun run;
  ASSERT_GT(static_cast<int64_t>(run.messages.size()), run.transitions);
  Log log;
  log.Add("FRESCO_WORLD", run.Names());
  for (const transitions_t& message : run.messages) {
    log.Add("FRESCO_TRANSITIONS", message);
  }
  log.Add("FRESCO_TRANSITIONS", run.messages.front());
  log.Add("FRESCO_TRANSITIONS", run.messages[1]);
  const auto json = log.Json()["runs"][0];
  EXPECT_EQ(json["episodes_whole"], 2);
  EXPECT_EQ(json["episodes_partial"], 0);
  EXPECT_EQ(json["transitions"], run.transitions);
  EXPECT_EQ(json["transitions_missing"], 0);
  EXPECT_EQ(json["transitions_repeated"], 1);
}

TEST(LogSummary, MissesATransitionOfWhichAPartIsMissing) {
  const WideRun run;
  for (const size_t lost : {size_t{0}, size_t{1}, run.messages.size() - 1}) {
    Log log;
    log.Add("FRESCO_WORLD", run.Names());
    for (size_t i = 0; i < run.messages.size(); ++i) {
      if (i != lost) {
        log.Add("FRESCO_TRANSITIONS", run.messages[i]);
      }
    }
    const auto json = log.Json()["runs"][0];
    EXPECT_EQ(json["episodes_whole"], 1) << lost;
    EXPECT_EQ(json["episodes_partial"], 1) << lost;
    EXPECT_EQ(json["transitions"], run.transitions - 1) << lost;
    EXPECT_EQ(json["transitions_repeated"], 0) << lost;
  }
}

TEST(LogSummary, CountsTheFirstPartsWhereNothingSaysHowManyThereAre) {
  const WideRun run;
  Log log;
  for (const transitions_t& message : run.messages) {
    log.Add("FRESCO_TRANSITIONS", message);
  }
  const auto json = log.Json()["runs"][0];
  EXPECT_EQ(json["episodes_whole"], 2);
  EXPECT_EQ(json["transitions"], run.transitions);
  EXPECT_EQ(json["transitions_repeated"], 0);
}

TEST(LogSummary, CountsForeignAndDamagedMessages) {
  Log log;
  auto damaged = Encoded(Status(1));
  damaged.back() ^= std::byte{1};
  log.AddBytes("FRESCO_ACTOR_STATUS", damaged);
  auto transitions = Encoded(Transitions(0, 0, 4, 1));
  transitions[60] ^= std::byte{1};
  log.AddBytes("FRESCO_TRANSITIONS", transitions);
  log.AddBytes("CAMERA", std::vector<std::byte>(20, std::byte{0xab}));
  log.AddBytes("FRESCO_ACTOR_STATUS", {});
  const auto json = log.Json();
  EXPECT_EQ(json["damaged_messages"], 2);
  EXPECT_EQ(json["foreign_messages"], 2);
  EXPECT_EQ(json["channels"][0]["type"], "foreign abababababababab");
  EXPECT_EQ(json["channels"][1]["type"], "mixed");
  EXPECT_TRUE(json["runs"].empty());
}

}  // namespace
}  // namespace fresco
