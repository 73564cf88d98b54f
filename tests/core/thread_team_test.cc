#include "core/thread_team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <set>
#include <vector>

namespace fresco {
namespace {

TEST(ThreadTeam, DoesEveryPartOnceAndReturnsWhenAllAreDone) {
  for (const int threads : {1, 2, 3, 8}) {
    ThreadTeam team(threads);
    EXPECT_EQ(team.threads(), threads);
    for (const int parts : {0, 1, 2, 3, 7, 100}) {
      for (int job = 0; job < 200; ++job) {
        std::vector<int> done(static_cast<size_t>(parts));  // not atomic: Run orders what the parts write
        team.Run(parts, [&](int part, int thread) {
          ++done[static_cast<size_t>(part)];
          EXPECT_TRUE(thread >= 0 && thread < threads);
        });
        ASSERT_EQ(done, std::vector<int>(static_cast<size_t>(parts), 1)) << threads << " " << parts;
      }
    }
  }
}

TEST(ThreadTeam, SharesTheParts) {
  constexpr int kThreads = 3;
  ThreadTeam team(kThreads);
  std::atomic<int> inside = 0;
  std::array<std::atomic<int>, kThreads> calls{};
  team.Run(kThreads, [&](int, int thread) {
    ++calls[static_cast<size_t>(thread)];
    ++inside;
    while (inside < kThreads) {  // a part can end only when every thread has one
      std::this_thread::yield();
    }
  });
  for (const std::atomic<int>& count : calls) {
    EXPECT_EQ(count, 1);
  }
}

TEST(ThreadTeam, EachJobSeesWhatTheOneBeforeItWrote) {
  ThreadTeam team(4);
  std::vector<int64_t> values(64, 1);
  for (int job = 0; job < 20'000; ++job) {
    const int shift = job % 63 + 1;
    std::vector<int64_t> next(values.size());
    team.Run(64, [&](int part, int) {
      const auto i = static_cast<size_t>(part);
      next[i] = (values[i] + values[(i + static_cast<size_t>(shift)) % values.size()]) % 1'000'003;
    });
    values.swap(next);
  }
  std::vector<int64_t> expected(64, 1);
  for (int job = 0; job < 20'000; ++job) {
    for (int64_t& value : expected) {
      value = 2 * value % 1'000'003;
    }
  }
  EXPECT_EQ(values, expected);
}

TEST(ThreadTeam, EndsWithoutAJob) {
  for (int i = 0; i < 50; ++i) {
    ThreadTeam team(4);
  }
}

}  // namespace
}  // namespace fresco
