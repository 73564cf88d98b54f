#include "processes/restart_policy.h"

#include <gtest/gtest.h>

#include <csignal>
#include <vector>

namespace fresco {
namespace {

constexpr int kKilled = 128 + SIGKILL;
constexpr int kFailed = 3;
constexpr int64_t kMomentUs = 5'000;
constexpr int64_t kLongUs = 60'000'000;

std::vector<int64_t> PausesMs(RestartPolicy& policy, int exit_status, int deaths) {
  std::vector<int64_t> pauses;
  for (int i = 0; i < deaths; ++i) {
    pauses.push_back(policy.NoteDeath(exit_status, kMomentUs) / 1000);
  }
  return pauses;
}

TEST(RestartPolicy, PausesEverLongerWhereItDiesRightAfterItsStartWhateverTheCause) {
  const std::vector<int64_t> expected = {100, 200, 400, 800, 1600, 3200, 5000, 5000};
  for (const int exit_status : {kKilled, 128 + SIGTERM, 128 + SIGSEGV, kFailed, 0}) {
    RestartPolicy policy;
    EXPECT_EQ(PausesMs(policy, exit_status, 8), expected) << exit_status;
  }
}

TEST(RestartPolicy, StartsAtOnceWhatHadWorkedForAWhile) {
  RestartPolicy policy;
  PausesMs(policy, kKilled, 6);
  EXPECT_EQ(policy.NoteDeath(kKilled, kLongUs), 0);
  EXPECT_EQ(policy.NoteDeath(kFailed, kLongUs), 0);
  EXPECT_EQ(PausesMs(policy, kKilled, 2), (std::vector<int64_t>{100, 200}));
}

TEST(RestartPolicy, GivesUpAfterFiveThatEndedByThemselvesRightAfterTheirStart) {
  for (const int exit_status : {kFailed, 0, 127, 128 + SIGSEGV}) {
    RestartPolicy policy;
    PausesMs(policy, exit_status, 4);
    EXPECT_FALSE(policy.hopeless()) << exit_status;
    PausesMs(policy, exit_status, 1);
    EXPECT_TRUE(policy.hopeless()) << exit_status;
  }
}

TEST(RestartPolicy, NeverGivesUpWhereSomebodyElseEndsIt) {
  RestartPolicy policy;
  PausesMs(policy, kKilled, 1000);
  PausesMs(policy, 128 + SIGTERM, 1000);
  EXPECT_FALSE(policy.hopeless());
}

TEST(RestartPolicy, CountsOnlyASuccession) {
  RestartPolicy policy;
  PausesMs(policy, kFailed, 4);
  PausesMs(policy, kKilled, 1);
  PausesMs(policy, kFailed, 4);
  EXPECT_FALSE(policy.hopeless());
  policy.NoteDeath(kFailed, kLongUs);
  PausesMs(policy, kFailed, 4);
  EXPECT_FALSE(policy.hopeless());
}

}  // namespace
}  // namespace fresco
