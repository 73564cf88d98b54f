// Compares both classes with plain sets of numbers.
#include "logs/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
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

constexpr int64_t kLength = 23;
constexpr int64_t kStep = 5;

TEST(EpisodeCoverage, CountsWhatArrivesInAnyOrderTwiceOrNotAtAll) {
  RandomStream stream(4, RandomPurpose::kTest, 0, 0);
  EpisodeCoverage coverage;
  std::map<int64_t, std::set<int64_t>> heard;
  int64_t sent = 0;
  for (int i = 0; i < 3000; ++i) {
    const int64_t order = stream.NextBelow(500);
    const int64_t first = kStep * stream.NextBelow(5);
    const int64_t count = std::min(kStep, kLength - first);
    coverage.Add(order, first, count, first + count == kLength);
    for (int64_t transition = first; transition < first + count; ++transition) {
      heard[order].insert(transition);
    }
    sent += count;
  }
  int64_t whole = 0;
  int64_t transitions = 0;
  int64_t missing = 0;
  for (const auto& [order, transitions_of] : heard) {
    const auto size = static_cast<int64_t>(transitions_of.size());
    whole += size == kLength ? 1 : 0;
    transitions += size;
    missing += *transitions_of.rbegin() + 1 - size;
  }
  ASSERT_GT(whole, 10);
  EXPECT_EQ(coverage.whole(), whole);
  EXPECT_EQ(coverage.partial(), static_cast<int64_t>(heard.size()) - whole);
  EXPECT_EQ(coverage.transitions(), transitions);
  EXPECT_EQ(coverage.repeated_transitions(), sent - transitions);
  EXPECT_EQ(coverage.missing_transitions(), missing);
}

TEST(EpisodeCoverage, KeepsItsCountsWhereItGivesUpPartialEpisodes) {
  EpisodeCoverage coverage(10);
  for (int64_t order = 0; order < 100; ++order) {
    coverage.Add(order, 1, 2, false);  // the first one is missing
  }
  EXPECT_EQ(coverage.partial(), 100);
  EXPECT_EQ(coverage.missing_transitions(), 100);
  coverage.Add(0, 0, 1, false);  // given up: too late
  EXPECT_EQ(coverage.transitions(), 200);
  EXPECT_EQ(coverage.repeated_transitions(), 1);
}

}  // namespace
}  // namespace fresco
