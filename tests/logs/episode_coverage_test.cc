// Held against a plain record of every transition.
#include "logs/episode_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/random.h"

namespace fresco {
namespace {

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
