#include "msgs/run_announcements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

namespace fresco {
namespace {

/// A part of a run's configuration.
run_t Part(int64_t run_id, int index, int count, const std::string& text) {
  run_t message{};
  message.run_id = run_id;
  message.config_hash = 9;
  message.part_index = index;
  message.part_count = count;
  message.part.assign(text.begin(), text.end());
  message.part_size = static_cast<int32_t>(text.size());
  return message;
}

TEST(RunAnnouncements, GivesTheTextOfASinglePart) {
  RunAnnouncements announcements;
  EXPECT_EQ(announcements.Add(Part(1, 0, 1, "text")), "text");
}

TEST(RunAnnouncements, JoinsPartsInTheirOrderWhateverTheArrival) {
  const std::vector<std::string> texts = {"one ", "two ", "", "four"};
  std::vector<int> arrival(texts.size());
  std::iota(arrival.begin(), arrival.end(), 0);
  do {
    RunAnnouncements announcements;
    for (size_t i = 0; i < arrival.size(); ++i) {
      const auto text = announcements.Add(Part(1, arrival[i], 4, texts[static_cast<size_t>(arrival[i])]));
      EXPECT_EQ(text.has_value(), i + 1 == arrival.size());
      EXPECT_EQ(text.value_or("one two four"), "one two four");
    }
  } while (std::next_permutation(arrival.begin(), arrival.end()));
}

TEST(RunAnnouncements, CountsARepeatedPartOnce) {
  RunAnnouncements announcements;
  EXPECT_FALSE(announcements.Add(Part(1, 0, 2, "a")));
  EXPECT_FALSE(announcements.Add(Part(1, 0, 2, "a")));
  EXPECT_EQ(announcements.Add(Part(1, 1, 2, "b")), "ab");
  EXPECT_EQ(announcements.Add(Part(1, 0, 2, "a")), "ab");  // for whoever was not ready for it
}

TEST(RunAnnouncements, NeverMixesTwoRunsThatAreInterleaved) {
  RunAnnouncements announcements;
  EXPECT_FALSE(announcements.Add(Part(1, 0, 2, "a")));
  EXPECT_FALSE(announcements.Add(Part(2, 1, 2, "B")));
  EXPECT_FALSE(announcements.Add(Part(1, 1, 2, "b")));  // its first part had to go
  EXPECT_FALSE(announcements.Add(Part(2, 0, 2, "A")));
  EXPECT_EQ(announcements.Add(Part(2, 1, 2, "B")), "AB");
  EXPECT_FALSE(announcements.Add(Part(1, 0, 2, "a")));
  EXPECT_EQ(announcements.Add(Part(1, 1, 2, "b")), "ab");
}

TEST(RunAnnouncements, TellsRunsApartByTheirConfigurationToo) {
  RunAnnouncements announcements;
  EXPECT_FALSE(announcements.Add(Part(1, 0, 2, "a")));
  run_t changed = Part(1, 1, 2, "B");
  changed.config_hash = 10;
  EXPECT_FALSE(announcements.Add(changed));
  changed = Part(1, 0, 2, "A");
  changed.config_hash = 10;
  EXPECT_EQ(announcements.Add(changed), "AB");
}

TEST(RunAnnouncements, BeginsAnewWhenTheNumberOfPartsChanges) {
  RunAnnouncements announcements;
  EXPECT_FALSE(announcements.Add(Part(1, 0, 3, "a")));
  EXPECT_FALSE(announcements.Add(Part(1, 1, 2, "b")));
  EXPECT_EQ(announcements.Add(Part(1, 0, 2, "A")), "Ab");
}

TEST(RunAnnouncements, PassesOverAbsurdCountsAndIndices) {
  constexpr int kLargest = std::numeric_limits<int>::max();
  constexpr int kSmallest = std::numeric_limits<int>::min();
  RunAnnouncements announcements;
  EXPECT_FALSE(announcements.Add(Part(1, 0, 2, "a")));
  for (const int count : {kSmallest, -1, 0, kMaximumParts + 1, kLargest}) {
    EXPECT_FALSE(announcements.Add(Part(1, 0, count, "x"))) << count;
  }
  for (const int index : {kSmallest, -1, 2, kMaximumParts, kLargest}) {
    EXPECT_FALSE(announcements.Add(Part(1, index, 2, "x"))) << index;
  }
  EXPECT_EQ(announcements.Add(Part(1, 1, 2, "b")), "ab");  // what was here has not suffered
}

TEST(RunAnnouncements, TakesTheLargestConfigurationThatIsAllowed) {
  RunAnnouncements announcements;
  const std::string part(kMaximumPartBytes, 'x');
  for (int index = kMaximumParts - 1; index > 0; --index) {
    ASSERT_FALSE(announcements.Add(Part(1, index, kMaximumParts, part)));
  }
  const auto text = announcements.Add(Part(1, 0, kMaximumParts, part));
  ASSERT_TRUE(text);
  EXPECT_EQ(text->size(), part.size() * kMaximumParts);
}

}  // namespace
}  // namespace fresco
