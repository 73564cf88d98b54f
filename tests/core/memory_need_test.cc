// What does not fit is refused, with the field, the bytes that are needed and those that there are.
#include "core/memory_need.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;

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
  try {
    RefuseIfTooLarge(Needs(), available);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_status(), 2);
    return error.what();
  }
  return "";
}

TEST(MemoryNeed, OfSeveralProcessesIsTheSumOfAllTheirParts) {
  EXPECT_EQ(Needs().front().bytes(), 6009 * kMega);
  EXPECT_EQ(RefusalWith(Available(6309 * kMega, 6009 * kMega)), "");
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
