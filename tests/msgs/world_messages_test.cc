// The names of a world over the bus: every one arrives, in any order of the messages.
#include "msgs/world_messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>

#include "tests/msgs/message_samples.h"
#include "tests/worlds/walk_world.h"

namespace fresco {
namespace {

WorldDescription DescriptionOf(int state_size, int actions, const std::string& prefix = "") {
  WorldDescription description = WalkWorld::Description();
  description.state.clear();
  description.actions.clear();
  for (int i = 0; i < state_size; ++i) {
    description.state.push_back({prefix + "field_" + std::to_string(i), i % 3 == 0 ? "m/s" : ""});
  }
  for (int i = 0; i < actions; ++i) {
    description.actions.push_back(prefix + "action [" + std::to_string(i) + "]");
  }
  description.figures = {{"margin_j", "J"}, {"steps", ""}};
  description.less_is_better = true;
  return description;
}

/// As they arrive.
std::vector<world_t> Sent(const World& world, int64_t run_id = 1) {
  std::vector<world_t> received;
  for (world_t message : WorldMessages(world)) {
    Stamp(message, {run_id, 9}, 0);
    EXPECT_TRUE(Decode(Encoded(message), received.emplace_back()));
  }
  return received;
}

void ExpectNames(const WorldNames* names, const WorldDescription& description) {
  ASSERT_NE(names, nullptr);
  const auto expect_equal = [](const std::vector<Quantity>& read, const std::vector<Quantity>& expected) {
    ASSERT_EQ(read.size(), expected.size());
    for (size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i].name, expected[i].name);
      EXPECT_EQ(read[i].unit, expected[i].unit);
    }
  };
  EXPECT_EQ(names->world, description.name);
  expect_equal(names->state, description.state);
  EXPECT_EQ(names->actions, description.actions);
  expect_equal(names->figures, description.figures);
  EXPECT_EQ(names->less_is_better, description.less_is_better);
  EXPECT_EQ(names->success, description.success);
}

TEST(WorldMessages, BringTheNamesOfWorldsOfAnySizeInAnyOrder) {
  std::mt19937 random(1);
  for (const auto& [state_size, actions] :
       {std::pair{1, 1}, {4, 2}, {7, 20}, {10'000, 1}, {1, 4000}, {10'000, 4000}}) {
    const WalkWorld world(DescriptionOf(state_size, actions));
    std::vector<world_t> messages = Sent(world);
    std::shuffle(messages.begin(), messages.end(), random);
    WorldNamesReader reader;
    for (const world_t& message : messages) {
      EXPECT_EQ(reader.names(), nullptr) << "not all have arrived";
      EXPECT_EQ(message.state_size, state_size);
      EXPECT_EQ(message.action_count, actions);
      EXPECT_EQ(message.longest_episode, world.longest_episode());
      reader.Add(message);
    }
    ExpectNames(reader.names(), world.description());
  }
}

TEST(WorldMessages, AreOneForASmallWorldAndFewForALargeOne) {
  EXPECT_EQ(Sent(WalkWorld()).size(), 1u);
  size_t bytes = 0;
  const WalkWorld large(DescriptionOf(10'000, 4000));
  const std::vector<world_t> messages = Sent(large);
  for (const world_t& message : messages) {
    bytes += message.entries.size();
  }
  EXPECT_LE(messages.size(), bytes / 950);  // each is nearly full
}

TEST(WorldNamesReader, CountsARepeatedMessageOnce) {
  const WalkWorld world(DescriptionOf(300, 5));
  const std::vector<world_t> messages = Sent(world);
  ASSERT_GE(messages.size(), 3u);
  WorldNamesReader reader;
  for (int round = 0; round < 5; ++round) {
    reader.Add(messages[0]);
    reader.Add(messages[1]);
    EXPECT_EQ(reader.names(), nullptr);
  }
  for (size_t i = 2; i < messages.size(); ++i) {
    reader.Add(messages[i]);
  }
  ExpectNames(reader.names(), world.description());
  reader.Add(messages[0]);
  ExpectNames(reader.names(), world.description());
}

TEST(WorldNamesReader, NeverMixesTwoRuns) {
  const WalkWorld one(DescriptionOf(300, 5, "a_"));
  const WalkWorld other(DescriptionOf(300, 5, "b_"));
  const std::vector<world_t> first = Sent(one, 1);
  const std::vector<world_t> second = Sent(other, 2);
  ASSERT_EQ(first.size(), second.size());
  WorldNamesReader reader;
  for (size_t i = 0; i < first.size(); ++i) {
    reader.Add(first[i]);
    EXPECT_EQ(reader.names(), nullptr);
    reader.Add(second[i]);
    EXPECT_EQ(reader.names(), nullptr);
  }
  for (const world_t& message : second) {
    reader.Add(message);
  }
  ExpectNames(reader.names(), other.description());
  for (const world_t& message : first) {
    reader.Add(message);
  }
  ExpectNames(reader.names(), one.description());
}

TEST(WorldNamesReader, PassesOverAbsurdNumbers) {
  constexpr int kLargest = std::numeric_limits<int32_t>::max();
  constexpr int kSmallest = std::numeric_limits<int32_t>::min();
  const WalkWorld world(DescriptionOf(300, 5));
  const std::vector<world_t> messages = Sent(world);
  WorldNamesReader reader;
  for (size_t i = 0; i + 1 < messages.size(); ++i) {
    reader.Add(messages[i]);
  }
  for (const int absurd : {kSmallest, -1, 0, kMaximumStateSize + 1, kLargest}) {
    for (int32_t world_t::*number : {&world_t::state_size, &world_t::action_count, &world_t::figure_count}) {
      world_t message = messages.back();
      message.*number = absurd;
      reader.Add(message);
    }
  }
  for (const int absurd : {kSmallest, -1, 307, kLargest}) {  // 307 entries in all
    world_t message = messages.back();
    message.first_entry = absurd;
    reader.Add(message);
  }
  EXPECT_EQ(reader.names(), nullptr);
  reader.Add(messages.back());
  ExpectNames(reader.names(), world.description());  // what was here has not suffered
}

TEST(WorldNamesReader, TakesWhateverDecodes) {
  RandomStream stream(3, RandomPurpose::kTest, 0, 0);
  WorldNamesReader reader;
  for (int i = 0; i < 2000; ++i) {
    auto message = RandomMessage<world_t>(stream);
    message.state_size = static_cast<int32_t>(stream.NextBelow(5));
    message.action_count = static_cast<int32_t>(stream.NextBelow(5));
    message.figure_count = static_cast<int32_t>(stream.NextBelow(5));
    message.first_entry = static_cast<int32_t>(stream.NextBelow(15)) - 1;
    Stamp(message, {1, 9}, 0);
    message.world = "w";
    std::replace(message.entries.begin(), message.entries.end(), 'e', '\n');
    std::replace(message.entries.begin(), message.entries.end(), 'f', '[');
    std::replace(message.entries.begin(), message.entries.end(), 'g', ']');
    std::replace(message.entries.begin(), message.entries.end(), 'h', ' ');
    reader.Add(message);
    if (reader.names() != nullptr) {
      EXPECT_LE(reader.names()->state.size(), 4u);
      EXPECT_LE(reader.names()->actions.size(), 4u);
    }
  }
}

}  // namespace
}  // namespace fresco
