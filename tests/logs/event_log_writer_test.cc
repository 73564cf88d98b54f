// LCM's own library reads what was written.
#include "logs/event_log_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/logs/event_log_files.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(EventLogWriter, WritesWhatLcmReads) {
  const TemporaryFolder folder;
  const auto events = SampleEvents(300);
  EventLogWriter writer(folder.path() / "log");
  for (const LogEvent& event : events) {
    writer.Write(EventOf(event));
  }
  writer.Flush();
  EXPECT_EQ(ReadWithLcm(folder.path() / "log"), events);
  EXPECT_EQ(ReadFile(folder.path() / "log"), LogBytes(events));
  EXPECT_EQ(writer.events(), 300);
  EXPECT_EQ(writer.bytes(), static_cast<int64_t>(LogBytes(events).size()));
  EXPECT_EQ(writer.files(), 1);
}

TEST(EventLogWriter, SplitsIntoPartsThatLcmReadsEachByItself) {
  const TemporaryFolder folder;
  const auto events = SampleEvents(100);
  std::vector<LogEvent> read;
  EventLogWriter writer(folder.path() / "log", 2000);
  for (const LogEvent& event : events) {
    writer.Write(EventOf(event));
  }
  writer.Flush();
  ASSERT_GT(writer.files(), 3);
  for (int part = 0; part < writer.files(); ++part) {
    const auto path = folder.path() / ("log.0" + std::to_string(part));
    const auto of_part = ReadWithLcm(path);
    read.insert(read.end(), of_part.begin(), of_part.end());
    EXPECT_EQ(std::filesystem::file_size(path) >= 2000, part + 1 < writer.files()) << path;
    EXPECT_LT(std::filesystem::file_size(path), 2000u + 28 + 400);
  }
  EXPECT_EQ(read, events);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "log"));
}

TEST(EventLogWriter, NeverWritesOverAFile) {
  const TemporaryFolder folder;
  for (const auto& [name, split_bytes] : {std::pair("log", 0), std::pair("log.00", 1000)}) {
    WriteBytes(folder.path() / name, "precious");
    EXPECT_THAT(ErrorOf([&, bytes = split_bytes] { EventLogWriter(folder.path() / "log", bytes); }),
                HasSubstr(name));
    EXPECT_EQ(ReadFile(folder.path() / name), "precious");
  }
}

TEST(EventLogWriter, NamesAFolderThatIsNotThere) {
  EXPECT_THAT(ErrorOf([] { EventLogWriter("/nonexistent/folder/log"); }),
              AllOf(HasSubstr("/nonexistent/folder/log"), HasSubstr("No such file")));
}

}  // namespace
}  // namespace fresco
