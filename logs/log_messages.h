// The messages of one or several LCM event logs, each as its sender encoded it. Belongs to one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bus/authentication_key.h"
#include "logs/merged_event_logs.h"
#include "msgs/message_decoder.h"

namespace fresco {

using LogPaths = std::vector<std::filesystem::path>;

/// Which logs, and whose messages of them.
struct LogSource {
  LogPaths paths;
  std::optional<AuthenticationKey> key =
      {};  ///< only messages with a tag of this key; none: whatever there is
};

struct LogMessage {
  std::string_view channel;
  std::span<const std::byte> content;  ///< without a tag; valid until the next is read

  /// Whether it is one of this type, and decodes.
  template <class Message>
  bool DecodeAs(Message& message) const {
    return BeginsAs<Message>(content) && Decode(content, message);
  }
};

class LogMessages {
 public:
  /// Throws UsageError where a log can't be read.
  explicit LogMessages(LogSource source) : source_(std::move(source)), logs_(source_.paths) {}

  /// The next, in the order in which they were received; nullopt at the end.
  std::optional<LogMessage> Next();

  /// Messages passed over for want of a tag of the key.
  int64_t refused() const { return refused_; }
  MergedEventLogs::Totals totals() const { return logs_.totals(); }

 private:
  LogSource source_;
  MergedEventLogs logs_;
  int64_t refused_ = 0;
};

}  // namespace fresco
