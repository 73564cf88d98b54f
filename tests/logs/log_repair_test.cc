// Repairs logs that are torn, have garbage in them, or flipped bits.
#include "logs/log_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "msgs/channels.h"
#include "tests/logs/event_log_files.h"
#include "tests/msgs/message_samples.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Kind = LogRepair::Loss::Kind;

class LogRepairTest : public testing::Test {
 protected:
  LogRepair Repair(const std::string& bytes) {
    WriteBytes(log_, bytes);
    std::filesystem::remove(out_);
    return RepairLog(log_, out_);
  }

  /// The position of an event in the sound log.
  int64_t Begin(size_t event) const {
    return static_cast<int64_t>(
        LogBytes({events_.begin(), events_.begin() + static_cast<ptrdiff_t>(event)}).size());
  }

  std::vector<LogEvent> Without(size_t event) const {
    std::vector<LogEvent> others = events_;
    others.erase(others.begin() + static_cast<ptrdiff_t>(event));
    return others;
  }

  TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / "log";
  std::filesystem::path out_ = folder_.path() / "out";
  std::vector<LogEvent> events_ = SampleEvents(20);
  std::string bytes_ = LogBytes(events_);
};

TEST_F(LogRepairTest, CopiesASoundLog) {
  const LogRepair repair = Repair(bytes_);
  EXPECT_EQ(ReadWithLcm(out_), events_);
  EXPECT_EQ(repair.losses, 0);
  EXPECT_EQ(repair.events, 20);
  EXPECT_THAT(RepairText(repair, log_, out_), HasSubstr("nothing is lost"));
}

TEST_F(LogRepairTest, LosesOnlyTheTornEvent) {
  const LogRepair repair = Repair(bytes_.substr(0, bytes_.size() - 3));
  EXPECT_EQ(ReadWithLcm(out_), Without(19));
  const int64_t end = static_cast<int64_t>(bytes_.size()) - 3;
  EXPECT_THAT(repair.listed, ElementsAre(LogRepair::Loss{Kind::kTorn, Begin(19), end}));
  EXPECT_EQ(repair.lost_bytes, end - Begin(19));
}

TEST_F(LogRepairTest, SkipsGarbageAndTellsWhereItWas) {
  std::string bytes = bytes_;
  bytes.insert(static_cast<size_t>(Begin(12)), 70, 'x');
  bytes.insert(static_cast<size_t>(Begin(5)), "garbage");
  const LogRepair repair = Repair(bytes);
  EXPECT_EQ(ReadWithLcm(out_), events_);
  EXPECT_THAT(repair.listed, ElementsAre(LogRepair::Loss{Kind::kDamaged, Begin(5), Begin(5) + 7},
                                         LogRepair::Loss{Kind::kDamaged, Begin(12) + 7, Begin(12) + 77}));
  EXPECT_EQ(repair.lost_bytes, 77);
  EXPECT_THAT(RepairText(repair, log_, out_),
              HasSubstr("from byte " + std::to_string(Begin(5)) + ": 7 bytes, damaged"));
}

TEST_F(LogRepairTest, LosesOneEventAtMostToABitInAHeader) {
  const std::vector<size_t> kSyncWordAndLengths = {0, 1, 2, 3, 20, 21, 22, 24, 25, 26};
  for (const size_t event : {0u, 7u, 18u}) {
    for (const size_t byte : kSyncWordAndLengths) {
      for (int bit = 0; bit < 8; ++bit) {
        std::string bytes = bytes_;
        bytes[static_cast<size_t>(Begin(event)) + byte] ^= static_cast<char>(1 << bit);
        const LogRepair repair = Repair(bytes);
        EXPECT_EQ(ReadWithLcm(out_), Without(event)) << event << " " << byte << " " << bit;
        EXPECT_THAT(repair.listed,
                    ElementsAre(LogRepair::Loss{Kind::kDamaged, Begin(event), Begin(event + 1)}));
      }
    }
  }
}

TEST_F(LogRepairTest, LeavesOutDamagedMessagesAndKeepsForeignOnes) {
  RandomStream stream(2, RandomPurpose::kTest, 0, 0);
  const auto message = Encoded(RandomMessage<learner_status_t>(stream));
  LogEvent status{
      1, "FRESCO_LEARNER_STATUS", {reinterpret_cast<const char*>(message.data()), message.size()}};
  events_[4] = status;
  events_[9] = status;
  events_[9].message[50] ^= 1;
  const LogRepair repair = Repair(LogBytes(events_));
  EXPECT_EQ(ReadWithLcm(out_), Without(9));
  EXPECT_THAT(repair.listed, ElementsAre(LogRepair::Loss{Kind::kDamagedMessage, Begin(9), Begin(10)}));
}

TEST_F(LogRepairTest, CountsMoreLossesThanItLists) {
  std::string bytes;
  for (int i = 0; i < 300; ++i) {
    bytes += LogBytes({events_[1]}) + "x";
  }
  const LogRepair repair = Repair(bytes);
  EXPECT_EQ(repair.losses, 300);
  EXPECT_EQ(repair.lost_bytes, 300);
  EXPECT_EQ(repair.listed.size(), LogRepair::kMaximumListed);
  EXPECT_THAT(RepairText(repair, log_, out_), HasSubstr("and 200 more places"));
}

TEST_F(LogRepairTest, NeverOverwritesAndMakesNoEmptyLog) {
  WriteBytes(log_, bytes_);
  EXPECT_THAT(ErrorOf([&] { RepairLog(log_, log_); }), HasSubstr("never written over"));
  WriteBytes(out_, "mine");
  EXPECT_THAT(ErrorOf([&] { RepairLog(log_, out_); }), HasSubstr("never written over"));
  for (const std::string& content : {std::string(), std::string("some text"), bytes_.substr(0, 10)}) {
    WriteBytes(log_, content);
    EXPECT_THAT(ErrorOf([&] { RepairLog(log_, folder_.path() / "new"); }),
                HasSubstr("at least one whole event"));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "new"));
  }
}

}  // namespace
}  // namespace fresco
