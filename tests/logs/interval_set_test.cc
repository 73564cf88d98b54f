// Held against a plain set of numbers.
#include "logs/interval_set.h"

#include <gtest/gtest.h>

#include <set>

#include "core/random.h"

namespace fresco {
namespace {

TEST(IntervalSet, IsASetOfNumbers) {
  RandomStream stream(3, RandomPurpose::kTest, 0, 0);
  IntervalSet intervals;
  std::set<int64_t> plain;
  for (int i = 0; i < 2000; ++i) {
    const int64_t first = stream.NextBelow(400);
    const int64_t last = first + (i % 3 == 0 ? stream.NextBelow(9) : 0);
    int64_t added = 0;
    for (int64_t number = first; number <= last; ++number) {
      added += plain.insert(number).second ? 1 : 0;
    }
    ASSERT_EQ(intervals.Add(first, last), added);
    ASSERT_EQ(intervals.count(), static_cast<int64_t>(plain.size()));
    ASSERT_EQ(intervals.first(), *plain.begin());
    ASSERT_EQ(intervals.last(), *plain.rbegin());
    const int64_t probe = stream.NextBelow(420);
    ASSERT_EQ(intervals.Contains(probe), plain.contains(probe)) << probe;
  }
}

TEST(IntervalSet, NamesItsGaps) {
  IntervalSet intervals;
  EXPECT_EQ(intervals.missing(), 0);
  for (const int64_t number : {7, 3, 4, 12, 6}) {
    intervals.Add(number, number);
  }
  EXPECT_EQ(intervals.missing(), 5);
  EXPECT_EQ(intervals.Gaps(9), (std::vector<Interval>{{5, 5}, {8, 11}}));
  EXPECT_EQ(intervals.Gaps(1), (std::vector<Interval>{{5, 5}}));
}

TEST(IntervalSet, CountsRightlyWhereItForgetsGaps) {
  IntervalSet intervals(3);
  for (int64_t number = 0; number < 20; number += 2) {
    EXPECT_EQ(intervals.Add(number, number), 1);
  }
  EXPECT_EQ(intervals.count(), 10);
  EXPECT_EQ(intervals.missing(), 9);
  EXPECT_EQ(intervals.Gaps(9), (std::vector<Interval>{{15, 15}, {17, 17}}));
  EXPECT_EQ(intervals.Add(1, 1), 0);
}

}  // namespace
}  // namespace fresco
