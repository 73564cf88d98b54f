#include "tests/logs/event_log_files.h"

#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <fstream>

#include "tests/bus/text_messages.h"

namespace fresco {
std::string BigEndian(uint64_t value, int size) {
  std::string bytes;
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) {
    bytes += static_cast<char>(value >> shift & 0xff);
  }
  return bytes;
}

LogEvent Owned(const LcmEvent& event) {
  return {event.utime, std::string(event.channel),
          std::string(reinterpret_cast<const char*>(event.message.data()), event.message.size())};
}

LcmEvent EventOf(const LogEvent& event) {
  return {0, event.utime, event.channel, Bytes(event.message)};
}

std::vector<LogEvent> SampleEvents(int count, int64_t first_utime) {
  std::vector<LogEvent> events;
  for (int i = 0; i < count; ++i) {
    std::string message;
    for (int j = 0; j < i * 37 % 200; ++j) {
      message += static_cast<char>(i * 31 + j * j);
    }
    if (i % 5 == 3) {
      message += "\xED\xA1\xDA\x01 within";
    }
    events.push_back(
        {first_utime + 1000 * i, "CHANNEL_" + std::string(static_cast<size_t>(i % 7), 'x'), message});
  }
  return events;
}

std::string LogBytes(const std::vector<LogEvent>& events) {
  std::string bytes;
  uint64_t number = 0;
  for (const LogEvent& event : events) {
    bytes += BigEndian(0xEDA1DA01, 4) + BigEndian(number++, 8) +
             BigEndian(static_cast<uint64_t>(event.utime), 8) + BigEndian(event.channel.size(), 4) +
             BigEndian(event.message.size(), 4);
    bytes += event.channel + event.message;
  }
  return bytes;
}

void WriteWithLcm(const std::filesystem::path& path, const std::vector<LogEvent>& events) {
  lcm_eventlog_t* log = lcm_eventlog_create(path.c_str(), "w");
  ASSERT_NE(log, nullptr);
  for (LogEvent event : events) {
    lcm_eventlog_event_t raw{};
    raw.timestamp = event.utime;
    raw.channel = event.channel.data();
    raw.channellen = static_cast<int32_t>(event.channel.size());
    raw.data = event.message.data();
    raw.datalen = static_cast<int32_t>(event.message.size());
    EXPECT_EQ(lcm_eventlog_write_event(log, &raw), 0);
  }
  lcm_eventlog_destroy(log);
}

std::vector<LogEvent> ReadWithLcm(const std::filesystem::path& path) {
  std::vector<LogEvent> events;
  lcm_eventlog_t* log = lcm_eventlog_create(path.c_str(), "r");
  EXPECT_NE(log, nullptr) << path;
  while (lcm_eventlog_event_t* raw = log == nullptr ? nullptr : lcm_eventlog_read_next_event(log)) {
    EXPECT_EQ(raw->eventnum, static_cast<int64_t>(events.size()));
    events.push_back({raw->timestamp, std::string(raw->channel, static_cast<size_t>(raw->channellen)),
                      std::string(static_cast<const char*>(raw->data), static_cast<size_t>(raw->datalen))});
    lcm_eventlog_free_event(raw);
  }
  if (log != nullptr) {
    lcm_eventlog_destroy(log);
  }
  return events;
}

void WriteBytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace fresco
