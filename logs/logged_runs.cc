#include "logs/logged_runs.h"

#include <fmt/format.h>

#include <algorithm>

#include "bus/authenticated_bus.h"
#include "core/error.h"
#include "core/identifier.h"
#include "msgs/run_announcements.h"

namespace fresco {

std::optional<LogMessage> LogMessages::Next() {
  while (const auto event = logs_.Next()) {
    const auto content = source_.key ? AuthenticContent(*source_.key, event->channel, event->message)
                                     : std::optional(WithoutAuthentication(event->message));
    if (content) {
      return LogMessage{event->channel, *content};
    }
    ++refused_;
  }
  return std::nullopt;
}

std::vector<LoggedRun> FindLoggedRuns(const LogSource& source) {
  std::vector<LoggedRun> runs;
  std::vector<RunAnnouncements> announcements;  // those of each run
  const auto index_of = [&](RunIdentity identity) {
    const auto found = std::find_if(runs.begin(), runs.end(),
                                    [&](const LoggedRun& run) { return run.identity == identity; });
    if (found != runs.end()) {
      return static_cast<size_t>(found - runs.begin());
    }
    runs.push_back({identity});
    announcements.emplace_back();
    return runs.size() - 1;
  };
  LogMessages messages(source);
  run_t run{};
  transitions_t transitions{};
  while (const auto message = messages.Next()) {
    if (message->DecodeAs(run)) {
      const size_t index = index_of(IdentityOf(run));
      runs[index].protocol_version = run.protocol_version;
      runs[index].arithmetic_fingerprint = run.arithmetic_fingerprint;
      if (!runs[index].config_text) {
        runs[index].config_text = announcements[index].Add(run);
      }
    } else if (message->DecodeAs(transitions)) {
      ++runs[index_of(IdentityOf(transitions))].transitions_messages;
    }
  }
  return runs;
}

LoggedRun ChooseLoggedRun(const std::vector<LoggedRun>& runs, const std::string& run_id) {
  std::string known;
  for (const LoggedRun& run : runs) {
    if (run_id.empty() ? runs.size() == 1 : IdentifierText(run.identity.run_id) == run_id) {
      return run;
    }
    known +=
        fmt::format("\n  {} (configuration {:08x}, {} messages of transitions)",
                    IdentifierText(run.identity.run_id), run.identity.config_hash, run.transitions_messages);
  }
  throw UsageError(
      runs.empty() ? "the log contains no run of Fresco"
      : run_id.empty()
          ? fmt::format("the log contains several runs; name one with --run ID:{}", known)
          : fmt::format("--run: the log does not contain run {}, but it contains{}", run_id, known));
}

void ExpectMessagesOfThisRelease(const LoggedRun& run) {
  if (run.protocol_version && *run.protocol_version != kProtocolVersion) {
    throw UsageError(
        fmt::format("run {} was recorded with protocol version {}, but this program has version {} and can't "
                    "read its transitions; use the release that recorded it",
                    IdentifierText(run.identity.run_id), *run.protocol_version, kProtocolVersion));
  }
}

}  // namespace fresco
