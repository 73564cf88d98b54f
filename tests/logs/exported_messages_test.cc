// Numbers and rows of exported tables, and events as JSON.
#include "logs/exported_messages.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/msgs/message_samples.h"
#include "worlds/cartpole/cartpole.h"

namespace fresco {
namespace {

TEST(CellOf, WritesAFloatInItsFewestDigitsAndKeepsEveryBit) {
  EXPECT_EQ(CsvLine({CellOf("reward", 0.1f), CellOf("reward", -2.5f)}), "0.1,-2.5\n");
  RandomStream stream(2, RandomPurpose::kTest, 0, 0);
  for (int i = 0; i < 20'000; ++i) {
    const float value = std::bit_cast<float>(stream.NextWord());
    if (std::isfinite(value)) {
      const float read = std::strtof(CsvLine({CellOf("reward", value)}).c_str(), nullptr);
      ASSERT_EQ(std::bit_cast<uint32_t>(read), std::bit_cast<uint32_t>(value));
    }
  }
}

TEST(CellOf, WritesIdentifiersAsSummaryJsonDoes) {
  EXPECT_EQ(CsvLine({CellOf("run_id", int64_t{0xabc}), CellOf("config_hash", int64_t{0xabc})}),
            "0000000000000abc,00000abc\n");
}

std::vector<NamedRow> RowsOf(const transitions_t& message, const WorldNames* names) {
  std::vector<NamedRow> rows;
  EXPECT_TRUE(ForEachTransitionRow(message, names, [&](const NamedRow& row) { rows.push_back(row); }));
  return rows;
}

std::vector<std::string> ColumnsOf(const NamedRow& row) {
  std::vector<std::string> columns;
  for (const auto& [column, value] : row) {
    columns.push_back(column);
  }
  return columns;
}

CsvCell CellIn(const NamedRow& row, const std::string& name) {
  for (const auto& [column, value] : row) {
    if (column == name) {
      return value;
    }
  }
  return "no such column";
}

/// What a program learns from the bus of CartPole's names.
class CartPoleNames {
 public:
  CartPoleNames() {
    for (const world_t& message : WorldMessages(CartPole(500))) {
      reader_.Add(message);
    }
  }
  const WorldNames* get() const { return reader_.names(); }

 private:
  WorldNamesReader reader_;
};

/// Two steps of CartPole, the last of which ends the episode.
transitions_t TwoSteps() {
  RandomStream stream(2, RandomPurpose::kTest, 1, 0);
  transitions_t message = TransitionsOf(stream, 2, 4, 2);
  Stamp(message, {0xabc, 7}, 9);
  message.order_index = 12;
  message.actor_id = 5;
  message.seed = -3;
  message.first_transition = 5;
  message.first_field = 0;
  message.ending = 2;
  message.state = {{0.1f, 1, 2, 3}, {-0.5f, 4, 5, 6}, {0.25f, 7, 8, 9}};
  message.action = {1, 0};
  message.reward = {1, -2.5f};
  message.td_error = {0.5f, 0};
  message.next_mask = {{0x03}, {0x02}};
  return message;
}

TEST(ForEachTransitionRow, HoldsAWholeStepWithTheNamesOfTheWorld) {
  const CartPoleNames names;
  ASSERT_NE(names.get(), nullptr);
  const std::vector<NamedRow> rows = RowsOf(TwoSteps(), names.get());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(ColumnsOf(rows[0]), (std::vector<std::string>{"utime",
                                                          "run_id",
                                                          "order_index",
                                                          "actor_id",
                                                          "seed",
                                                          "transition",
                                                          "ending",
                                                          "position",
                                                          "velocity",
                                                          "angle",
                                                          "angular_velocity",
                                                          "action",
                                                          "action_name",
                                                          "reward",
                                                          "td_error",
                                                          "next_position",
                                                          "next_velocity",
                                                          "next_angle",
                                                          "next_angular_velocity",
                                                          "next_allowed_actions"}));
  EXPECT_EQ(ColumnsOf(rows[1]), ColumnsOf(rows[0]));
  EXPECT_EQ(CellIn(rows[0], "run_id"), CsvCell("0000000000000abc"));
  EXPECT_EQ(CellIn(rows[0], "transition"), CsvCell(int64_t{5}));
  EXPECT_EQ(CellIn(rows[1], "transition"), CsvCell(int64_t{6}));
  EXPECT_EQ(CellIn(rows[0], "seed"), CsvCell(int64_t{-3}));
  EXPECT_EQ(CellIn(rows[0], "ending"), CsvCell("none"));
  EXPECT_EQ(CellIn(rows[1], "ending"), CsvCell("truncated"));
  EXPECT_EQ(CellIn(rows[0], "position"), CsvCell(0.1));
  EXPECT_EQ(CellIn(rows[0], "angular_velocity"), CsvCell(3.0));
  EXPECT_EQ(CellIn(rows[0], "next_position"), CsvCell(-0.5));
  EXPECT_EQ(CellIn(rows[1], "position"), CsvCell(-0.5));
  EXPECT_EQ(CellIn(rows[1], "next_angle"), CsvCell(8.0));
  EXPECT_EQ(CellIn(rows[0], "action"), CsvCell(int64_t{1}));
  EXPECT_EQ(CellIn(rows[0], "action_name"), CsvCell("push right"));
  EXPECT_EQ(CellIn(rows[1], "action_name"), CsvCell("push left"));
  EXPECT_EQ(CellIn(rows[1], "reward"), CsvCell(-2.5));
  EXPECT_EQ(CellIn(rows[0], "next_allowed_actions"), CsvCell("0 1"));
  EXPECT_EQ(CellIn(rows[1], "next_allowed_actions"), CsvCell("1"));
}

TEST(ForEachTransitionRow, HasNumbersWhereTheNamesAreNotKnown) {
  const std::vector<NamedRow> rows = RowsOf(TwoSteps(), nullptr);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(CellIn(rows[0], "state_0"), CsvCell(0.1));
  EXPECT_EQ(CellIn(rows[0], "state_3"), CsvCell(3.0));
  EXPECT_EQ(CellIn(rows[0], "next_state_0"), CsvCell(-0.5));
  EXPECT_EQ(CellIn(rows[0], "action"), CsvCell(int64_t{1}));
  EXPECT_EQ(CellIn(rows[0], "action_name"), CsvCell(""));
  EXPECT_EQ(CellIn(rows[0], "next_allowed_actions"), CsvCell("0 1"));
  EXPECT_EQ(ColumnsOf(rows[0]).size(), 20u);
}

TEST(ForEachTransitionRow, HasTheRightFieldsOfAStateThatIsInSeveralMessages) {
  transitions_t message = TwoSteps();
  message.first_field = 300;
  EXPECT_EQ(CellIn(RowsOf(message, nullptr)[0], "state_302"), CsvCell(2.0));
  EXPECT_EQ(CellIn(RowsOf(message, nullptr)[0], "next_state_303"), CsvCell(6.0));
}

TEST(ForEachTransitionRow, HasNumbersForWhatTheNamesDoNotName) {
  const CartPoleNames names;
  transitions_t message = TwoSteps();
  message.first_field = 2;
  message.action = {2, -1};
  const std::vector<NamedRow> rows = RowsOf(message, names.get());
  EXPECT_EQ(CellIn(rows[0], "angle"), CsvCell(0.1));
  EXPECT_EQ(CellIn(rows[0], "state_4"), CsvCell(2.0));
  EXPECT_EQ(CellIn(rows[0], "action_name"), CsvCell(""));
  EXPECT_EQ(CellIn(rows[1], "action"), CsvCell(int64_t{-1}));
}

TEST(ForEachTransitionRow, RefusesNumbersThatContradictOneAnother) {
  const auto refuses = [](const transitions_t& message) {
    return !ForEachTransitionRow(message, nullptr, [](const NamedRow&) { FAIL(); });
  };
  transitions_t message = TwoSteps();
  message.state_count = 2;
  message.state.resize(2);
  EXPECT_TRUE(refuses(message));
  for (const int ending : {-128, -1, 3, 127}) {
    message = TwoSteps();
    message.ending = static_cast<int8_t>(ending);
    EXPECT_TRUE(refuses(message)) << ending;
  }
  message = TwoSteps();
  message.first_field = -1;
  EXPECT_TRUE(refuses(message));
}

TEST(ForEachRow, HasAllFieldsOfAMessageAndItsListsAsJson) {
  RandomStream stream(2, RandomPurpose::kTest, 5, 0);
  actor_status_t status = ActorStatusOf(stream, 2, 0, 3);
  Stamp(status, {0xabc, 7}, 9);
  status.host = "h\"1";
  status.held = {chunk_range_t{}, chunk_range_t{}};
  const auto bytes = Encoded(status);
  MessageDecoder decoder;
  std::vector<NamedRow> rows;
  const auto take = [&](const NamedRow& row) { rows.push_back(row); };
  EXPECT_EQ(ForEachRow({0, 5, "A", bytes}, decoder, {}, take), MessageDecoder::Result::kDecoded);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(CellIn(rows[0], "run_id"), CsvCell("0000000000000abc"));
  EXPECT_EQ(CellIn(rows[0], "host"), CsvCell("h\"1"));
  EXPECT_EQ(CellIn(rows[0], "missing"), CsvCell("[]"));
  const auto held = nlohmann::json::parse(std::get<std::string>(CellIn(rows[0], "held")));
  ASSERT_EQ(held.size(), 2u);
  EXPECT_EQ(held[1]["count"], 0);
  const run_t run = RunOf(stream, 5);
  rows.clear();
  ForEachRow({0, 5, "A", Encoded(run)}, decoder, {}, take);
  EXPECT_EQ(CellIn(rows.at(0), "part"), CsvCell(std::string(run.part.begin(), run.part.end())));
}

TEST(ForEachRow, HasNoRowOfWhatIsDamagedContradictsItselfOrIsForeign) {
  MessageDecoder decoder;
  const auto result = [&](std::span<const std::byte> bytes) {
    return ForEachRow({0, 5, "A", bytes}, decoder, {}, [](const NamedRow&) { FAIL(); });
  };
  transitions_t message = TwoSteps();
  message.ending = 3;
  const auto bytes = Encoded(message);
  EXPECT_EQ(result(bytes), MessageDecoder::Result::kDamaged);
  EXPECT_EQ(result(std::span(bytes).first(50)), MessageDecoder::Result::kDamaged);
  EXPECT_EQ(result({}), MessageDecoder::Result::kForeign);
}

TEST(EventJson, NamesFieldsAndActionsOnceTheirNamesWereSeen) {
  MessageDecoder decoder;
  WorldNamesByRun names;
  const transitions_t message = TwoSteps();
  const auto bytes = Encoded(message);
  const LcmEvent event{0, 5, "FRESCO_TRANSITIONS", bytes};
  EXPECT_TRUE(nlohmann::json::parse(EventJson(event, decoder, names))["message"]["state"][0].is_array());
  for (const int64_t run_id : {int64_t{0xdef}, int64_t{0xabc}}) {  // another run's names are of no use
    EXPECT_EQ(names.Of(0xabc), nullptr);
    for (world_t world : WorldMessages(CartPole(500))) {
      Stamp(world, {run_id, 7}, 1);
      const auto encoded = Encoded(world);
      names.Add({0, 4, "FRESCO_WORLD", encoded});
    }
  }
  const auto json = nlohmann::json::parse(EventJson(event, decoder, names))["message"];
  ASSERT_EQ(json["state"].size(), message.state.size());
  EXPECT_EQ(json["state"][1]["angle"].get<float>(), message.state[1][2]);
  ASSERT_EQ(json["action_name"].size(), message.action.size());
  EXPECT_EQ(json["action_name"][0], message.action[0] == 0 ? "push left" : "push right");
  EXPECT_EQ(json["action"][0], message.action[0]);
}

TEST(EventJson, ShowsEveryKindOfEvent) {
  MessageDecoder decoder;
  RandomStream stream(2, RandomPurpose::kTest, 3, 0);
  transitions_t message = TransitionsOf(stream, 2, 3, 20);
  Stamp(message, {0x123456789abcdef0, 0xcafe0001}, 1);
  message.order_index = 3;
  const auto bytes = Encoded(message);
  auto json = nlohmann::json::parse(EventJson({0, 5, "FRESCO_TRANSITIONS", bytes}, decoder));
  EXPECT_EQ(json["type"], "transitions_t");
  EXPECT_EQ(json["message"]["run_id"], "123456789abcdef0");
  EXPECT_EQ(json["message"]["order_index"], 3);
  EXPECT_EQ(json["message"]["state"].size(), 3u);
  EXPECT_EQ(json["message"]["state"][2].size(), 3u);
  EXPECT_EQ(json["message"]["state"][2][1].get<float>(), message.state[2][1]);
  json = nlohmann::json::parse(EventJson({0, 5, "FRESCO_TRANSITIONS", std::span(bytes).first(99)}, decoder));
  EXPECT_EQ(json["type"], "transitions_t");
  EXPECT_EQ(json["damaged"], true);
  EXPECT_EQ(json["bytes"], 99);
  const std::vector<std::byte> foreign(9, std::byte{0xff});
  json = nlohmann::json::parse(EventJson({0, 5, "\xff", foreign}, decoder));
  EXPECT_EQ(json["type"], nullptr);
  EXPECT_EQ(json["fingerprint"], "ffffffffffffffff");
}

}  // namespace
}  // namespace fresco
