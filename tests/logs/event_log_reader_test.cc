// Reads event logs that LCM's own library wrote: whole, cut at every byte, and damaged.
#include "logs/event_log_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/logs/event_log_files.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::HasSubstr;

constexpr size_t kChannelLengthOffset = 20;
constexpr size_t kMessageLengthOffset = 24;

struct Reading {
  std::vector<LogEvent> events;
  int64_t damaged_bytes = 0;
  int64_t torn_bytes = 0;
};

Reading ReadAll(const std::filesystem::path& path) {
  EventLogReader reader(path);
  Reading reading;
  while (const auto event = reader.Next()) {
    reading.events.push_back(Owned(*event));
  }
  reading.damaged_bytes = reader.damaged_bytes();
  reading.torn_bytes = reader.torn_bytes();
  EXPECT_EQ(reader.position() + reader.torn_bytes(), static_cast<int64_t>(std::filesystem::file_size(path)));
  return reading;
}

Reading ReadBytes(const std::string& bytes) {
  const TemporaryFolder folder;
  WriteBytes(folder.path() / "log", bytes);
  return ReadAll(folder.path() / "log");
}

std::string RefusalOf(const std::filesystem::path& path) {
  return ErrorOf([&] { EventLogReader{path}; });
}

void SetLength(std::string& bytes, size_t offset, uint32_t length) {
  for (size_t i = 0; i < 4; ++i) {
    bytes[offset + i] = static_cast<char>(length >> (24 - 8 * i));
  }
}

/// Returns the position of each event, and of the log's end.
std::vector<size_t> Boundaries(const std::vector<LogEvent>& events) {
  std::vector<size_t> boundaries = {0};
  for (const LogEvent& event : events) {
    boundaries.push_back(boundaries.back() + LogBytes({event}).size());
  }
  return boundaries;
}

TEST(EventLogReader, ReadsWhatLcmWrites) {
  const TemporaryFolder folder;
  const auto events = SampleEvents(300);
  WriteWithLcm(folder.path() / "log", events);
  EventLogReader reader(folder.path() / "log");
  for (size_t i = 0; i < events.size(); ++i) {
    const auto event = reader.Next();
    ASSERT_TRUE(event);
    EXPECT_EQ(Owned(*event), events[i]);
    EXPECT_EQ(event->number, static_cast<int64_t>(i));
  }
  EXPECT_FALSE(reader.Next());
  EXPECT_EQ(reader.damaged_bytes(), 0);
  EXPECT_EQ(reader.torn_bytes(), 0);
}

TEST(EventLogReader, ReadsEventsLargerThanItsBlock) {
  std::vector<LogEvent> events = SampleEvents(3);
  events[1].message = std::string(5 << 20, 'm');
  const Reading reading = ReadBytes(LogBytes(events));
  EXPECT_EQ(reading.events, events);
}

TEST(EventLogReader, ReadsALogThatIsCutAtAnyByteToTheCut) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  const auto events = SampleEvents(9);
  const std::string bytes = LogBytes(events);
  const std::vector<size_t> boundaries = Boundaries(events);
  for (size_t size = 0; size <= bytes.size(); ++size) {
    WriteBytes(path, bytes.substr(0, size));
    const auto behind = std::upper_bound(boundaries.begin(), boundaries.end(), size);
    const Reading reading = ReadAll(path);
    ASSERT_EQ(reading.events.size(), static_cast<size_t>(behind - boundaries.begin() - 1)) << size;
    EXPECT_TRUE(std::equal(reading.events.begin(), reading.events.end(), events.begin())) << size;
    EXPECT_EQ(reading.torn_bytes, static_cast<int64_t>(size - *(behind - 1)));
    EXPECT_EQ(reading.damaged_bytes, 0) << size;
  }
}

TEST(EventLogReader, SkipsAnEventWhoseSyncWordIsFlipped) {
  const auto events = SampleEvents(9);
  const std::vector<size_t> boundaries = Boundaries(events);
  for (size_t flipped = 1; flipped < events.size(); ++flipped) {
    std::string bytes = LogBytes(events);
    bytes[boundaries[flipped] + 2] ^= 1;
    const Reading reading = ReadBytes(bytes);
    std::vector<LogEvent> expected = events;
    expected.erase(expected.begin() + static_cast<ptrdiff_t>(flipped));
    EXPECT_EQ(reading.events, expected) << flipped;
    // No event follows the last one, so the end of its damage is not known.
    const auto lost = static_cast<int64_t>(boundaries[flipped + 1] - boundaries[flipped]);
    EXPECT_EQ(reading.damaged_bytes + reading.torn_bytes, lost) << flipped;
  }
}

TEST(EventLogReader, KeepsAnEventWithTheSyncWordInItBeforeDamage) {
  std::vector<LogEvent> events = SampleEvents(2);
  events.back().message = "\xED\xA1\xDA\x01";
  events.back().message.resize(90);
  const Reading reading = ReadBytes(LogBytes(events) + "rubbish" + LogBytes(events));
  EXPECT_EQ(reading.events, (std::vector{events[0], events[1], events[0], events[1]}));
  EXPECT_EQ(reading.damaged_bytes, 7);
}

TEST(EventLogReader, TakesNoTimeBeyondMeasureForADamagedLogOfMegabytes) {
  std::string bytes = LogBytes({{1, "A", "before"}});
  std::string header = LogBytes({{1, "A", ""}}).substr(0, 28);
  SetLength(header, kMessageLengthOffset, 200 << 20);
  for (int i = 0; i < 100'000; ++i) {
    bytes += header;
  }
  const Reading reading = ReadBytes(bytes + LogBytes({{2, "B", "behind"}}));
  EXPECT_EQ(reading.events, (std::vector<LogEvent>{{1, "A", "before"}, {2, "B", "behind"}}));
  EXPECT_EQ(reading.damaged_bytes, 100'000 * 28);
}

TEST(EventLogReader, LosesNoOtherEventToADamagedLength) {
  const auto events = SampleEvents(12);
  const std::vector<size_t> boundaries = Boundaries(events);
  std::vector<LogEvent> others = events;
  others.erase(others.begin() + 4);
  for (const size_t offset : {kChannelLengthOffset, kMessageLengthOffset}) {
    for (const uint32_t length :
         {0xffffffffu, 0x80000000u, 0x7fffffffu, 0x10000000u, 1'000'000u, 700u, 300u}) {
      std::string bytes = LogBytes(events);
      SetLength(bytes, boundaries[4] + offset, length);
      const Reading reading = ReadBytes(bytes);
      EXPECT_EQ(reading.events, others) << offset << " " << length;
      EXPECT_GT(reading.damaged_bytes, 0);
    }
  }
}

TEST(EventLogReader, GoesOnBehindAnEventWhoseLengthIsTooSmall) {
  const auto events = SampleEvents(12);
  const std::vector<size_t> boundaries = Boundaries(events);
  std::string bytes = LogBytes(events);
  SetLength(bytes, boundaries[4] + kMessageLengthOffset, static_cast<uint32_t>(events[4].message.size()) - 5);
  const Reading reading = ReadBytes(bytes);
  // The event itself lacks its end. Nothing in the log shows that.
  ASSERT_EQ(reading.events.size(), events.size());
  EXPECT_TRUE(std::equal(events.begin() + 5, events.end(), reading.events.begin() + 5));
  EXPECT_EQ(reading.damaged_bytes, 5);
}

TEST(EventLogReader, FindsTheNextEventBehindMegabytesOfRubbish) {
  const auto events = SampleEvents(4);
  const std::vector<size_t> boundaries = Boundaries(events);
  for (const size_t rubbish : {1u, 3u, 4u, (1u << 20) - 2, 3u << 20}) {
    std::string bytes = LogBytes(events);
    bytes.insert(boundaries[2], std::string(rubbish, '\xED'));
    const Reading reading = ReadBytes(bytes);
    EXPECT_EQ(reading.events, events) << rubbish;
    EXPECT_EQ(reading.damaged_bytes, static_cast<int64_t>(rubbish));
  }
}

TEST(EventLogReader, TakesAnEmptyFileAsALogWithoutEvents) {
  EXPECT_TRUE(ReadBytes("").events.empty());
  EXPECT_EQ(ReadBytes("abc").torn_bytes, 3);
}

TEST(EventLogReader, RefusesWhatIsNoLogSayingWhatIs) {
  const TemporaryFolder folder;
  WriteBytes(folder.path() / "text", "utime,channel\n1,A\n");
  EXPECT_THAT(RefusalOf(folder.path() / "text"), HasSubstr("ED A1 DA 01"));
  EXPECT_THAT(RefusalOf(folder.path()), HasSubstr("event log"));
  EXPECT_THAT(RefusalOf(folder.path() / "none"), HasSubstr("No such file"));
}

TEST(EventLogReader, GoesOnWhereALogHasGrown) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  const auto events = SampleEvents(20);
  const std::string bytes = LogBytes(events);
  WriteBytes(path, "");
  EventLogReader reader(path);
  std::ofstream growing(path, std::ios::binary | std::ios::app);
  std::vector<LogEvent> read;
  for (size_t begin = 0; begin < bytes.size(); begin += 7) {
    growing << bytes.substr(begin, 7) << std::flush;
    while (const auto event = reader.Next()) {
      read.push_back(Owned(*event));
    }
  }
  EXPECT_EQ(read, events);
  EXPECT_EQ(reader.torn_bytes(), 0);
  EXPECT_EQ(reader.damaged_bytes(), 0);
}

}  // namespace
}  // namespace fresco
