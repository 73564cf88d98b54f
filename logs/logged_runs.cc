#include "logs/logged_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <iterator>

#include "bus/authenticated_bus.h"
#include "core/error.h"
#include "core/identifier.h"
#include "msgs/run_announcements.h"

namespace fresco {
namespace {

/// Collects runs by their identity, in the order in which they appear.
class Runs {
 public:
  void Take(const run_t& message) {
    Entry& entry = Of(IdentityOf(message));
    entry.run.protocol_version = message.protocol_version;
    entry.run.arithmetic_fingerprint = message.arithmetic_fingerprint;
    if (!entry.run.config_text) {
      entry.run.config_text = entry.announcements.Add(message);
    }
  }
  void Take(const transitions_t& message) { ++Of(IdentityOf(message)).run.transitions_messages; }

  std::vector<LoggedRun> All() && {
    std::vector<LoggedRun> runs;
    std::transform(entries_.begin(), entries_.end(), std::back_inserter(runs),
                   [](Entry& entry) { return std::move(entry.run); });
    return runs;
  }

 private:
  struct Entry {
    LoggedRun run;
    RunAnnouncements announcements = {};
  };

  Entry& Of(RunIdentity identity) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& entry) { return entry.run.identity == identity; });
    return found != entries_.end() ? *found : entries_.emplace_back(Entry{{identity}});
  }

  std::deque<Entry> entries_;
};

}  // namespace

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
  Runs runs;
  LogMessages messages(source);
  run_t run{};
  transitions_t transitions{};
  while (const auto message = messages.Next()) {
    if (message->DecodeAs(run)) {
      runs.Take(run);
    } else if (message->DecodeAs(transitions)) {
      runs.Take(transitions);
    }
  }
  return std::move(runs).All();
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

void ExpectOrdersOfThisRelease(const LoggedRun& run) {
  if (run.protocol_version && *run.protocol_version != kProtocolVersion) {
    throw UsageError(
        fmt::format("run {} was recorded with protocol version {}, but this program has version {}: its "
                    "orders mean other episodes here, so the weights would differ; use the release that "
                    "recorded it, or train another agent on its episodes (another schedule or agent, with "
                    "--set)",
                    IdentifierText(run.identity.run_id), *run.protocol_version, kProtocolVersion));
  }
}

}  // namespace fresco
