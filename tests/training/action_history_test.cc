#include "training/action_history.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"

namespace fresco {
namespace {

/// Every episode in a list, and from it what the history must give.
class LiteralHistory {
 public:
  void Add(const std::vector<int16_t>& episode) { episodes_.push_back(episode); }

  std::vector<int16_t> Actions(size_t capacity) const {
    std::vector<int16_t> actions;
    for (auto episode = episodes_.rbegin(); episode != episodes_.rend() && actions.size() < capacity;
         ++episode) {
      actions.insert(actions.begin(), episode->begin(), episode->end());
    }
    return actions;
  }

 private:
  std::vector<std::vector<int16_t>> episodes_;
};

TEST(ActionHistory, IsEmptyAtFirst) {
  EXPECT_TRUE(ActionHistory(10, 4).Actions().empty());
}

TEST(ActionHistory, KeepsWholeEpisodesDownToTheOldestTransitionInTheReplayMemory) {
  constexpr int kLongest = 9;
  for (const int capacity : {1, 8, 9, 10, 57}) {
    RandomStream stream(4, RandomPurpose::kTest, static_cast<uint32_t>(capacity), 0);
    ActionHistory history(capacity, kLongest);
    LiteralHistory literal;
    for (int number = 0; number < 60; ++number) {
      std::vector<int16_t> episode(1 + stream.NextBelow(kLongest));
      for (int16_t& action : episode) {
        action = static_cast<int16_t>(stream.NextBelow(20));
      }
      for (size_t i = 0; i < episode.size(); ++i) {
        history.Add(episode[i], i + 1 == episode.size());
      }
      literal.Add(episode);
      ASSERT_EQ(history.Actions(), literal.Actions(static_cast<size_t>(capacity)))
          << capacity << ", " << number;
    }
  }
}

}  // namespace
}  // namespace fresco
