// Reads the messages of one or several LCM event logs, each as its sender encoded it. Only one thread may use
// an object.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bus/authenticated_bus.h"
#include "logs/merged_event_logs.h"
#include "msgs/message_decoder.h"

namespace fresco {

using LogPaths = std::vector<std::filesystem::path>;

/// Which logs to read, and which of their messages.
struct LogSource {
  LogPaths paths;
  /// If set, only messages that are authenticated with this key are read.
  std::optional<AuthenticationKey> key = {};
};

struct LogMessage {
  std::string_view channel;
  std::span<const std::byte> content;  ///< without the authentication tag; valid until the next message is
                                       ///< read

  /// Decodes the message. Returns false if it is of another type or does not decode.
  template <class Message>
  bool DecodeAs(Message& message) const {
    return BeginsAs<Message>(content) && Decode(content, message);
  }
};

class LogMessages {
 public:
  /// Throws UsageError if a log can't be read.
  explicit LogMessages(LogSource source) : source_(std::move(source)), logs_(source_.paths) {}

  /// Returns the next message, in the order in which they were received; nullopt at the end.
  std::optional<LogMessage> Next();

  /// The number of messages left out because they are not authenticated with the key.
  int64_t refused() const { return refused_; }
  MergedEventLogs::Totals totals() const { return logs_.totals(); }

 private:
  LogSource source_;
  MergedEventLogs logs_;
  int64_t refused_ = 0;
};

}  // namespace fresco
