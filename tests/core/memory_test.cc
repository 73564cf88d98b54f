// What there is: the least of what the kernel, the control groups and the resource limits leave, from files
// written by hand. What does not fit is refused, with the field, the bytes needed and the bytes available.
#include "core/memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "tests/support/error_of.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int64_t kGib = int64_t{1} << 30;

class AvailableMemoryTest : public ::testing::Test {
 protected:
  AvailableMemoryTest() {
    Write("proc/meminfo", "MemTotal: 67108864 kB\nMemFree: 1024 kB\nMemAvailable: 33554432 kB\n");
  }

  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  MemoryLimit Host() const { return ReadAvailableMemory(root_).host; }

  const TemporaryFolder folder_;
  const std::filesystem::path& root_ = folder_.path();
};

TEST_F(AvailableMemoryTest, IsWhatTheKernelSaysWithoutControlGroups) {
  EXPECT_EQ(Host().bytes, 32 * kGib);
  EXPECT_EQ(Host().source, "MemAvailable in /proc/meminfo");
}

// 8 GiB limit, 5 GiB taken, of which 3 GiB are file pages that can be dropped.
TEST_F(AvailableMemoryTest, IsWhatAControlGroupOfVersion2Leaves) {
  Write("proc/self/cgroup", "0::/a/b\n");
  Write("sys/fs/cgroup/a/b/memory.max", "8589934592\n");
  Write("sys/fs/cgroup/a/b/memory.current", "5368709120\n");
  Write("sys/fs/cgroup/a/b/memory.stat", "anon 5\ninactive_file 2147483648\nactive_file 1073741824\n");
  EXPECT_EQ(Host().bytes, 6 * kGib);
  EXPECT_NE(Host().source.find("a/b/memory.max"), std::string::npos) << Host().source;
}

TEST_F(AvailableMemoryTest, IsWhatTheTightestOfTheGroupsAboveLeaves) {
  Write("proc/self/cgroup", "0::/a/b\n");
  Write("sys/fs/cgroup/a/b/memory.max", "max\n");
  Write("sys/fs/cgroup/a/b/memory.current", "5368709120\n");
  Write("sys/fs/cgroup/a/memory.max", "8589934592\n");
  Write("sys/fs/cgroup/a/memory.current", "5368709120\n");
  EXPECT_EQ(Host().bytes, 3 * kGib);
}

TEST_F(AvailableMemoryTest, IsFoundInAContainerThatSeesTheUppermostFolderOnly) {
  Write("proc/self/cgroup", "12:cpu,memory:/docker/0123\n0::/\n");
  Write("sys/fs/cgroup/memory/memory.limit_in_bytes", "4294967296\n");
  Write("sys/fs/cgroup/memory/memory.usage_in_bytes", "3221225472\n");
  Write("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 1073741824\n");
  EXPECT_EQ(Host().bytes, 2 * kGib);
}

TEST_F(AvailableMemoryTest, IsNothingRatherThanNegativeAboveTheLimit) {
  Write("proc/self/cgroup", "0::/\n");
  Write("sys/fs/cgroup/memory.max", "1000\n");
  Write("sys/fs/cgroup/memory.current", "5000\n");
  EXPECT_EQ(Host().bytes, 0);
}

TEST_F(AvailableMemoryTest, OfWhatCantBeReadIsNoLimit) {
  std::filesystem::remove_all(root_);
  EXPECT_EQ(Host().source, "no limit");
  Write("proc/meminfo", "MemAvailable: nonsense\n");
  Write("proc/self/cgroup", "nonsense\n");
  EXPECT_EQ(Host().source, "no limit");
}

TEST_F(AvailableMemoryTest, OfOneProcessIsWhatItsResourceLimitsLeave) {
  if (kSanitized) {
    GTEST_SKIP() << "a sanitizer takes terabytes of addresses";
  }
  Write("proc/self/status", "VmSize: 1048576 kB\nVmData: 524288 kB\n");  // 1 GiB and 0.5 GiB are taken
  EXPECT_EQ(ReadAvailableMemory(root_).process.bytes, 32 * kGib);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_DATA, &before), 0);
  const rlimit lower{static_cast<rlim_t>(3 * kGib), before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &lower), 0);
  const AvailableMemory available = ReadAvailableMemory(root_);
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &before), 0);
  EXPECT_EQ(available.process.bytes, 5 * kGib / 2);
  EXPECT_EQ(available.process.source, "ulimit -d");
  EXPECT_EQ(available.host.bytes, 32 * kGib);
}

constexpr int64_t kMega = 1'000'000;

std::vector<MemoryNeed> Needs() {
  return {{"learner",
           1,
           {{"agent.replay_capacity", "the replay memory", 5000 * kMega},
            {"agent.batch_size", "a batch", 1000 * kMega},
            {"scenario.grid", "the field", 1 * kMega},
            {"", "the program", 8 * kMega}}},
          {"actor", 3, {{"schedule.window", "the episodes", 100 * kMega}}}};
}

AvailableMemory Available(int64_t host, int64_t process) {
  return {{host, "what the host has"}, {process, "what one process may have"}};
}

std::string RefusalWith(const AvailableMemory& available) {
  return ErrorOf([&] { RefuseIfTooLarge(Needs(), available); });
}

TEST(MemoryNeed, OfSeveralProcessesIsTheSumOfAllTheirParts) {
  EXPECT_EQ(Needs().front().bytes(), 6009 * kMega);
  EXPECT_NO_THROW(RefuseIfTooLarge(Needs(), Available(6309 * kMega, 6009 * kMega)));
  EXPECT_NE(RefusalWith(Available(6309 * kMega - 1, 6009 * kMega)), "");
  EXPECT_NE(RefusalWith(Available(6309 * kMega, 6009 * kMega - 1)), "");
}

TEST(MemoryNeed, ThatIsTooLargeIsRefusedWithFieldsAndBytes) {
  EXPECT_EQ(
      RefusalWith(Available(2000 * kMega, 9000 * kMega)),
      "agent.replay_capacity: the replay memory needs 5.0 GB; in all 6.3 GB of memory are needed and 2.0 GB "
      "are available (what the host has). In detail: the learner 6.0 GB: 5.0 GB for the replay memory "
      "(agent.replay_capacity), 1.0 GB for a batch (agent.batch_size); each of 3 actors 100.0 MB: 100.0 MB "
      "for the episodes (schedule.window). Lower agent.replay_capacity, or run it where there is more "
      "memory");
  EXPECT_THAT(RefusalWith(Available(9000 * kMega, 2000 * kMega)),
              AllOf(HasSubstr("6.0 GB of memory are needed"), HasSubstr("what one process may have")));
}

TEST(MemoryNeed, OfNoProcessIsNone) {
  std::vector<MemoryNeed> needs = Needs();
  needs.front().processes = 0;
  EXPECT_NO_THROW(RefuseIfTooLarge(needs, Available(300 * kMega, 100 * kMega)));
}

TEST(HeapBytes, AreThoseOfGlibcsBlocks) {
  EXPECT_EQ(HeapBytes(1), 32);
  EXPECT_EQ(HeapBytes(24), 32);
  EXPECT_EQ(HeapBytes(25), 48);
  EXPECT_EQ(HeapBytes(1000), 1008);
}

}  // namespace
}  // namespace fresco
