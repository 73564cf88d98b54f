// Every message of a bus is in the log, or is counted as dropped.
#include "logs/recorder.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "tests/logs/event_log_files.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

void Publish(Bus& bus, const std::vector<LogEvent>& events) {
  for (const LogEvent& event : events) {
    bus.Publish(event.channel, EventOf(event).message);
  }
}

std::vector<std::string> Messages(const std::vector<LogEvent>& events) {
  std::vector<std::string> messages;
  for (const LogEvent& event : events) {
    messages.push_back(event.channel + " " + event.message);
  }
  return messages;
}

TEST(Recorder, WritesWhatIsOnTheBusUpToItsEnd) {
  const TemporaryFolder folder;
  const auto bus = OpenLcmBus("memq://");
  Recorder recorder(*bus, {folder.path() / "log"});
  const auto events = SampleEvents(5000);
  Publish(*bus, events);
  recorder.Step(1'000'000);
  Publish(*bus, events);
  const auto totals = recorder.Finish();
  const auto read = ReadWithLcm(folder.path() / "log");
  const auto once = Messages(events);
  auto expected = once;
  expected.insert(expected.end(), once.begin(), once.end());
  EXPECT_TRUE(Messages(read) == expected);  // too much to print
  EXPECT_EQ(totals.events, 10'000);
  EXPECT_EQ(totals.bytes, static_cast<int64_t>(std::filesystem::file_size(folder.path() / "log")));
  EXPECT_EQ(totals.dropped_events, 0);
  EXPECT_EQ(totals.files, 1);
}

TEST(Recorder, CountsWhatFindsNoRoomAndKeepsTheRest) {
  const TemporaryFolder folder;
  const auto bus = OpenLcmBus("memq://");
  Recorder recorder(*bus, {.path = folder.path() / "log", .memory_bytes = 10'000});
  const std::vector<LogEvent> events = {{0, "A", "1"}, {0, "A", std::string(6000, 'x')}, {0, "A", "2"}};
  Publish(*bus, events);
  const auto totals = recorder.Finish();
  EXPECT_EQ(totals.dropped_events, 1);
  EXPECT_EQ(Messages(ReadWithLcm(folder.path() / "log")), (std::vector<std::string>{"A 1", "A 2"}));
}

TEST(Recorder, RecordsOnlyTheChannelsThatAreAskedFor) {
  const TemporaryFolder folder;
  const auto bus = OpenLcmBus("memq://");
  Recorder recorder(*bus, {.path = folder.path() / "log", .channels = {{"FRESCO_.*", "B"}, "--channel"}});
  Publish(*bus, {{0, "FRESCO_RUN", "1"}, {0, "A_FRESCO_RUN", "2"}, {0, "B", "3"}, {0, "BB", "4"}});
  recorder.Finish();
  EXPECT_EQ(Messages(ReadWithLcm(folder.path() / "log")), (std::vector<std::string>{"FRESCO_RUN 1", "B 3"}));
}

TEST(Recorder, KeepsTheOldLogWhereOneIsThere) {
  const TemporaryFolder folder;
  const auto bus = OpenLcmBus("memq://");
  WriteBytes(folder.path() / "log", "precious");
  EXPECT_THROW(Recorder(*bus, {folder.path() / "log"}), Error);
}

}  // namespace
}  // namespace fresco
