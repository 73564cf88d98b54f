// Numbers and rows of exported tables, and events as JSON.
#include "logs/exported_messages.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/msgs/message_samples.h"

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

TEST(ForEachTransitionRow, HoldsAWholeStep) {
  RandomStream stream(2, RandomPurpose::kTest, 1, 0);
  transitions_t message = TransitionsOf(stream, 2, 1);
  message.first_transition = 5;
  message.outcome = 2;
  message.column = {1, 2, 3};
  message.action = {3, 9};  // east with sensor 1; hover with sensor 1, of 2 a move
  message.next_mask = {{0x05, 0x02}, {0, 0}};
  std::vector<NamedRow> rows;
  ASSERT_TRUE(ForEachTransitionRow(message, [&](const NamedRow& row) { rows.push_back(row); }));
  ASSERT_EQ(rows.size(), 2u);
  const auto cell = [&](size_t row, const std::string& name) -> CsvCell {
    for (const auto& [column, value] : rows[row]) {
      if (column == name) {
        return value;
      }
    }
    return "no such column";
  };
  EXPECT_EQ(cell(0, "transition"), CsvCell(int64_t{5}));
  EXPECT_EQ(cell(0, "outcome"), CsvCell("flying"));
  EXPECT_EQ(cell(0, "move"), CsvCell("south"));
  EXPECT_EQ(cell(0, "scheduled"), CsvCell(int64_t{1}));
  EXPECT_EQ(cell(0, "column"), CsvCell(int64_t{1}));
  EXPECT_EQ(cell(0, "next_column"), CsvCell(int64_t{2}));
  EXPECT_EQ(cell(0, "next_allowed_actions"), CsvCell("0 2 9"));
  EXPECT_EQ(cell(0, "terminal"), CsvCell(int64_t{0}));
  EXPECT_EQ(cell(1, "terminal"), CsvCell(int64_t{1}));
  EXPECT_EQ(cell(1, "move"), CsvCell("hover"));
}

TEST(ForEachTransitionRow, RefusesCountsThatContradictOneAnother) {
  RandomStream stream(2, RandomPurpose::kTest, 2, 0);
  transitions_t message = TransitionsOf(stream, 2, 1);
  message.outcome = 0;
  message.state_count = 2;
  message.column.resize(2);
  EXPECT_FALSE(ForEachTransitionRow(message, [](const NamedRow&) { FAIL(); }));
}

TEST(EventJson, ShowsEveryKindOfEvent) {
  MessageDecoder decoder;
  RandomStream stream(2, RandomPurpose::kTest, 3, 0);
  transitions_t message = TransitionsOf(stream, 2, 3);
  Stamp(message, {0x123456789abcdef0, 0xcafe0001}, 1);
  message.order_index = 3;
  const auto bytes = Encoded(message);
  auto json = nlohmann::json::parse(EventJson({0, 5, "FRESCO_TRANSITIONS", bytes}, decoder));
  EXPECT_EQ(json["type"], "transitions_t");
  EXPECT_EQ(json["message"]["run_id"], "123456789abcdef0");
  EXPECT_EQ(json["message"]["order_index"], 3);
  EXPECT_EQ(json["message"]["aoi"].size(), 3u);
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
