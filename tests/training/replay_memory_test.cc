#include "training/replay_memory.h"
#include "core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace fresco {
namespace {

constexpr int kInputs = 3;
constexpr int kActions = 11;  // two bytes of mask, the second one not full

/// Whether action `action` is allowed after transition `k`: some pattern, never empty.
bool AllowedAfter(int k, int action) {
  return action == k % kActions || (k * 7 + action * action) % 3 == 0;
}

void InsertTransition(int k, ReplayMemory& memory) {
  const auto value = static_cast<float>(k);
  const std::vector<float> observation = {value, value + 0.25f, value + 0.5f};
  const std::vector<float> next_observation = {-value, 1 / (value + 1), value * value};
  std::vector<uint8_t> mask(2, 0);
  for (int action = 0; action < kActions; ++action) {
    if (AllowedAfter(k, action)) {
      mask[static_cast<size_t>(action / 8)] |= static_cast<uint8_t>(1 << (action % 8));
    }
  }
  memory.Insert({observation, next_observation, static_cast<int16_t>(k % kActions), value * 0.5f - 3,
                 value / 8, mask, value - 100});
}

ReplayMemory MemoryOf(int transitions, int64_t capacity) {
  ReplayMemory memory(kInputs, kActions, capacity);
  for (int k = 0; k < transitions; ++k) {
    InsertTransition(k, memory);
  }
  return memory;
}

/// Which transitions the columns of the batch are.
std::vector<int> Drawn(const MiniBatch& batch) {
  std::vector<int> drawn;
  for (int column = 0; column < batch.size(); ++column) {
    drawn.push_back(static_cast<int>(std::lround(batch.observations(0, column))));
  }
  return drawn;
}

std::vector<int> Draw(const ReplayMemory& memory, int count, uint32_t stream_index) {
  MiniBatch batch(kInputs, kActions, count);
  RandomStream stream(1, RandomPurpose::kTest, stream_index, 0);
  memory.Sample(stream, batch);
  return Drawn(batch);
}

std::set<int> Range(int first, int end) {
  std::set<int> range;
  for (int k = first; k < end; ++k) {
    range.insert(k);
  }
  return range;
}

TEST(ReplayMemory, GivesBackWhatWasInserted) {
  const ReplayMemory memory = MemoryOf(23, 10);
  MiniBatch batch(kInputs, kActions, 200);
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  memory.Sample(stream, batch);
  ASSERT_EQ(batch.size(), 200);
  const std::vector<int> drawn = Drawn(batch);
  for (int column = 0; column < batch.size(); ++column) {
    const auto i = static_cast<size_t>(column);
    const int k = drawn[i];
    const auto value = static_cast<float>(k);
    EXPECT_EQ(batch.least_values[i], value - 100);
    EXPECT_EQ(batch.observations.col(column),
              Vector::Map(std::vector{value, value + 0.25f, value + 0.5f}.data(), 3));
    EXPECT_EQ(batch.next_observations.col(column),
              Vector::Map(std::vector{-value, 1 / (value + 1), value * value}.data(), 3));
    EXPECT_EQ(batch.actions[i], k % kActions);
    EXPECT_EQ(batch.rewards[i], value * 0.5f - 3);
    EXPECT_EQ(batch.discounts[i], value / 8);
    for (int action = 0; action < kActions; ++action) {
      EXPECT_EQ(batch.next_mask(column)[static_cast<size_t>(action)], AllowedAfter(k, action) ? 1 : 0);
    }
  }
}

TEST(ReplayMemory, GrowsToItsCapacity) {
  ReplayMemory memory(kInputs, kActions, 5);
  EXPECT_EQ(memory.size(), 0);
  for (int k = 0; k < 13; ++k) {
    InsertTransition(k, memory);
    EXPECT_EQ(memory.size(), std::min(k + 1, 5));
  }
}

TEST(ReplayMemory, HoldsTheLatestTransitions) {
  for (const int transitions : {1, 2, 9, 10, 11, 19, 20, 21, 57}) {
    const std::vector<int> drawn = Draw(MemoryOf(transitions, 10), 400, 2);
    EXPECT_EQ(std::set<int>(drawn.begin(), drawn.end()), Range(std::max(0, transitions - 10), transitions));
  }
}

TEST(ReplayMemory, HoldsOneTransitionInACapacityOfOne) {
  EXPECT_EQ(Draw(MemoryOf(8, 1), 3, 2), (std::vector{7, 7, 7}));
}

TEST(ReplayMemory, DrawsUniformlyWithReplacement) {
  constexpr int kPlaces = 20;
  constexpr int kDraws = 20'000;
  const std::vector<int> drawn = Draw(MemoryOf(kPlaces, 50), kDraws, 3);
  std::vector<int> counts(kPlaces, 0);
  int repeated = 0;
  for (size_t i = 0; i < drawn.size(); ++i) {
    ++counts.at(static_cast<size_t>(drawn[i]));
    repeated += i > 0 && drawn[i] == drawn[i - 1] ? 1 : 0;
  }
  constexpr double kExpected = double{kDraws} / kPlaces;
  double chi_square = 0;
  for (const int count : counts) {
    chi_square += (count - kExpected) * (count - kExpected) / kExpected;
  }
  EXPECT_LT(chi_square, 43.8);  // 19 degrees of freedom: exceeded once in a thousand
  EXPECT_GT(chi_square, 5.4);   // and not reached once in a thousand
  EXPECT_NEAR(repeated, kExpected, 5 * std::sqrt(kExpected));
}

TEST(ReplayMemory, DrawsTheSameBatchFromTheSameStream) {
  const ReplayMemory memory = MemoryOf(40, 40);
  EXPECT_EQ(Draw(memory, 100, 4), Draw(MemoryOf(40, 40), 100, 4));
  EXPECT_NE(Draw(memory, 100, 4), Draw(memory, 100, 5));
}

TEST(ReplayMemory, OverwritesAllOfABatch) {
  const ReplayMemory memory = MemoryOf(30, 30);
  MiniBatch used(kInputs, kActions, 50);
  MiniBatch fresh(kInputs, kActions, 50);
  RandomStream stream(1, RandomPurpose::kTest, 6, 0);
  memory.Sample(stream, used);
  RandomStream continued = stream;
  memory.Sample(stream, used);
  memory.Sample(continued, fresh);
  EXPECT_EQ(used.observations, fresh.observations);
  EXPECT_EQ(used.next_observations, fresh.next_observations);
  EXPECT_EQ(used.actions, fresh.actions);
  EXPECT_EQ(used.rewards, fresh.rewards);
  EXPECT_EQ(used.discounts, fresh.discounts);
  EXPECT_TRUE(used.next_masks == fresh.next_masks);
}

TEST(ReplayMemoryDeathTest, ChecksThatThereIsSomethingToDraw) {
  const ReplayMemory memory = MemoryOf(0, 10);
  EXPECT_DEATH(Draw(memory, 1, 0), "size_ >= 1");
}

TEST(ReplayMemoryDeathTest, ChecksTheSizesOfATransition) {
  ReplayMemory memory(kInputs, kActions, 10);
  const std::vector<float> observation(kInputs);
  const std::vector<float> longer(kInputs + 1);
  const std::vector<uint8_t> mask(2);
  const std::vector<uint8_t> shorter(1);
  EXPECT_DEATH(memory.Insert({longer, observation, 0, 0, 1, mask}), "observation.size");
  EXPECT_DEATH(memory.Insert({observation, observation, 0, 0, 1, shorter}), "next_mask.size");
}

/// An episode of so many transitions, with nothing in it but a number to know it by.
std::shared_ptr<const Episode> NumberedEpisode(int number, size_t transitions) {
  Episode episode;
  episode.ending = Ending::kTerminal;
  episode.actions.assign(transitions, static_cast<int16_t>(number));
  return std::make_shared<const Episode>(std::move(episode));
}

TEST(EpisodeHistory, IsEmptyAtFirst) {
  EXPECT_TRUE(EpisodeHistory(10).episodes().empty());
}

TEST(EpisodeHistory, KeepsWholeEpisodesDownToTheOldestTransitionInTheReplayMemory) {
  constexpr int kLongest = 9;
  for (const int capacity : {1, 8, 9, 10, 57}) {
    RandomStream stream(4, RandomPurpose::kTest, static_cast<uint32_t>(capacity), 0);
    EpisodeHistory history(capacity);
    std::vector<std::shared_ptr<const Episode>> all;
    for (int number = 0; number < 60; ++number) {
      all.push_back(NumberedEpisode(number, 1 + stream.NextBelow(kLongest)));
      history.Add(all.back());
      std::vector<std::shared_ptr<const Episode>> expected;  // from the newest back, until they are enough
      for (int transitions = 0; transitions < capacity && expected.size() < all.size();) {
        expected.insert(expected.begin(), all[all.size() - 1 - expected.size()]);
        transitions += expected.front()->transitions();
      }
      ASSERT_EQ(history.episodes(), expected) << capacity << ", " << number;
    }
  }
}

TEST(EpisodeHistory, ForgetsTheEpisodesThatItDoesNotKeep) {
  EpisodeHistory history(7);
  const std::weak_ptr<const Episode> first = [&] {
    const auto episode = NumberedEpisode(0, 5);
    history.Add(episode);
    return std::weak_ptr(episode);
  }();
  history.Add(NumberedEpisode(1, 6));
  EXPECT_FALSE(first.expired()) << "its last transition is one of the latest seven";
  history.Add(NumberedEpisode(2, 1));
  EXPECT_TRUE(first.expired());
}

}  // namespace
}  // namespace fresco
