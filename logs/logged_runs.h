// Reads the messages of one or several LCM event logs, and finds the runs that they are of, by the learners'
// announcements and the identity in each message.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/authenticated_bus.h"
#include "logs/merged_event_logs.h"
#include "msgs/message_decoder.h"
#include "msgs/wire.h"

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

/// Reads the messages, each as its sender encoded it. Only one thread may use an object.
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

struct LoggedRun {
  RunIdentity identity;
  int64_t transitions_messages = 0;
  std::optional<int32_t> protocol_version = {};        ///< of its messages; none if it was not recorded
  std::optional<int64_t> arithmetic_fingerprint = {};  ///< of the learner; none if it was not recorded
  std::optional<std::string> config_text = {};         ///< none if some part of it was not recorded
};

// Any thread may call the following functions.

/// Returns the runs of which transitions or the configuration were recorded, in the order in which they
/// appear. Throws UsageError if a log can't be read.
std::vector<LoggedRun> FindLoggedRuns(const LogSource& source);

/// Returns the run with this id (in the form of IdentifierText), or the only run if the text is empty. Throws
/// UsageError that lists the runs if there is no such run or if the text is empty and there are several.
LoggedRun ChooseLoggedRun(const std::vector<LoggedRun>& runs, const std::string& run_id);

/// Throws UsageError if another release recorded the run: this one can't read its transitions.
void ExpectMessagesOfThisRelease(const LoggedRun& run);

}  // namespace fresco
