#include "logs/event_log_writer.h"

#include <fmt/format.h>
#include <lcm/lcm.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"
#include "logs/event_log_reader.h"

namespace fresco {

class EventLogWriter::File {
 public:
  explicit File(const std::filesystem::path& path) : log_(lcm_eventlog_create(path.c_str(), "w")) {}

  bool is_open() const { return log_ != nullptr; }
  bool Flush() { return std::fflush(log_->f) == 0; }

  bool Write(const LcmEvent& event) {
    channel_.assign(event.channel);
    lcm_eventlog_event_t raw{};
    raw.timestamp = event.utime;
    raw.channellen = static_cast<int32_t>(channel_.size());
    raw.channel = channel_.data();
    raw.datalen = static_cast<int32_t>(event.message.size());
    raw.data = const_cast<std::byte*>(event.message.data());  // NOLINT: LCM's C code only reads it
    return lcm_eventlog_write_event(log_.get(), &raw) == 0;
  }

 private:
  struct CloseLog {
    void operator()(lcm_eventlog_t* log) const { lcm_eventlog_destroy(log); }
  };

  std::unique_ptr<lcm_eventlog_t, CloseLog> log_;
  std::string channel_;
};

EventLogWriter::EventLogWriter(std::filesystem::path path, int64_t split_bytes)
    : path_(std::move(path)), split_bytes_(split_bytes) {
  OpenNext();
}

EventLogWriter::~EventLogWriter() = default;

void EventLogWriter::Write(const LcmEvent& event) {
  if (split_bytes_ > 0 && bytes_ >= split_bytes_) {
    Flush();
    OpenNext();
  }
  if (!file_->Write(event)) {
    ThrowDiskError();
  }
  ++events_;
  bytes_ += EventBytes(event);
}

int64_t EventLogWriter::EventBytes(const LcmEvent& event) {
  return static_cast<int64_t>(kEventHeaderBytes + event.channel.size() + event.message.size());
}

void EventLogWriter::Flush() {
  if (!file_->Flush()) {
    ThrowDiskError();
  }
}

void EventLogWriter::OpenNext() {
  file_path_ = path_;
  if (split_bytes_ > 0) {
    file_path_ += fmt::format(".{:02}", files_);
  }
  if (std::filesystem::exists(file_path_)) {
    throw UsageError(
        fmt::format("{} exists already, and logs are never written over; name another file, or move that "
                    "one away",
                    file_path_.string()));
  }
  file_ = std::make_unique<File>(file_path_);
  if (!file_->is_open()) {
    throw UsageError(fmt::format("can't make the log {}: {}", file_path_.string(), std::strerror(errno)));
  }
  ++files_;
  bytes_before_ += std::exchange(bytes_, 0);
}

void EventLogWriter::ThrowDiskError() const {
  throw Failure(fmt::format("can't write to the log {}: {}; the events before this one can be read",
                            file_path_.string(), std::strerror(errno)));
}

}  // namespace fresco
