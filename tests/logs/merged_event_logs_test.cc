// Reads several logs as one: parts of a split log, and recordings of several hosts.
#include "logs/merged_event_logs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "logs/event_log_writer.h"
#include "tests/logs/event_log_files.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using Paths = std::vector<std::filesystem::path>;

std::vector<LogEvent> ReadAll(MergedEventLogs& logs) {
  std::vector<LogEvent> events;
  while (const auto event = logs.Next()) {
    events.push_back(Owned(*event));
  }
  return events;
}

TEST(MergedEventLogs, JoinThePartsOfASplitLogInAnyOrder) {
  const TemporaryFolder folder;
  const auto events = SampleEvents(100);
  EventLogWriter writer(folder.path() / "log", 2000);
  for (const LogEvent& event : events) {
    writer.Write(EventOf(event));
  }
  writer.Flush();
  Paths paths;
  for (int part = writer.files(); part-- > 0;) {
    paths.push_back(folder.path() / ("log.0" + std::to_string(part)));
  }
  MergedEventLogs logs(paths);
  EXPECT_EQ(ReadAll(logs), events);
  EXPECT_EQ(logs.totals().bytes, writer.bytes());
}

TEST(MergedEventLogs, OrderOverlappingLogsByTime) {
  const TemporaryFolder folder;
  const auto events = SampleEvents(300);
  std::vector<std::vector<LogEvent>> shares(3);
  for (size_t i = 0; i < events.size(); ++i) {
    shares[i * i % 3].push_back(events[i]);  // the third gets none
  }
  Paths paths;
  for (const auto& share : shares) {
    paths.push_back(folder.path() / std::to_string(paths.size()));
    WriteWithLcm(paths.back(), share);
  }
  MergedEventLogs logs(paths);
  EXPECT_EQ(ReadAll(logs), events);
}

TEST(MergedEventLogs, PutTheFirstNamedFirstAtTheSameTime) {
  const TemporaryFolder folder;
  WriteWithLcm(folder.path() / "a", {{5, "A", "1"}, {7, "A", "2"}, {7, "A", "3"}});
  WriteWithLcm(folder.path() / "b", {{5, "B", "1"}, {7, "B", "2"}});
  for (const bool a_first : {true, false}) {
    MergedEventLogs logs(a_first ? Paths{folder.path() / "a", folder.path() / "b"}
                                 : Paths{folder.path() / "b", folder.path() / "a"});
    std::string order;
    for (const LogEvent& event : ReadAll(logs)) {
      order += event.channel + event.message + " ";
    }
    EXPECT_EQ(order, a_first ? "A1 B1 A2 A3 B2 " : "B1 A1 B2 A2 A3 ");
  }
}

TEST(MergedEventLogs, KeepAnEventInItsPlaceWhoseClockWentBackwards) {
  const TemporaryFolder folder;
  WriteWithLcm(folder.path() / "a", {{5, "A", "1"}, {2, "A", "2"}, {9, "A", "3"}});
  WriteWithLcm(folder.path() / "b", {{3, "B", "1"}, {6, "B", "2"}});
  MergedEventLogs logs({folder.path() / "a", folder.path() / "b"});
  std::string order;
  for (const LogEvent& event : ReadAll(logs)) {
    order += event.channel + event.message + " ";
  }
  EXPECT_EQ(order, "B1 A1 A2 B2 A3 ");
}

TEST(MergedEventLogs, CountCutsAndDamageOfAll) {
  const TemporaryFolder folder;
  const std::string bytes = LogBytes(SampleEvents(4));
  WriteBytes(folder.path() / "cut", bytes.substr(0, bytes.size() - 3));
  WriteBytes(folder.path() / "damaged", bytes + "rubbish" + bytes);
  WriteBytes(folder.path() / "empty", "");
  MergedEventLogs logs({folder.path() / "cut", folder.path() / "damaged", folder.path() / "empty"});
  EXPECT_EQ(ReadAll(logs).size(), 3u + 8u);
  EXPECT_EQ(logs.totals().bytes, static_cast<int64_t>(3 * bytes.size() - 3 + 7));
  EXPECT_EQ(logs.totals().damaged_bytes, 7);
  EXPECT_EQ(logs.totals().torn_bytes, static_cast<int64_t>(LogBytes({SampleEvents(4)[3]}).size()) - 3);
}

TEST(MergedEventLogs, RefuseAFileThatIsNoLogBeforeAnythingIsRead) {
  const TemporaryFolder folder;
  WriteWithLcm(folder.path() / "a", SampleEvents(2));
  EXPECT_THROW(MergedEventLogs({folder.path() / "a", folder.path() / "none"}), Error);
}

}  // namespace
}  // namespace fresco
