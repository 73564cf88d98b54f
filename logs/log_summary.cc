#include "logs/log_summary.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/identifier.h"
#include "logs/exported_messages.h"
#include "msgs/order.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr size_t kMaximumRecords = 4096;  // of each kind; a limit, since anybody may send names
constexpr int64_t kMaximumOrder = int64_t{1} << 32;
constexpr int64_t kMaximumSequence = int64_t{1} << 53;

void NoteType(const char* type, std::span<const std::byte> message, ChannelTraffic& channel) {
  const bool same = type != nullptr ? channel.type == type : channel.type.starts_with("foreign");
  if (channel.events == 0) {
    channel.type = type != nullptr ? type : "foreign " + FingerprintText(message);
  } else if (!same) {
    channel.type = "mixed";
  }
}

void NoteOrder(int64_t index, RunTraffic& run) {
  if (index >= 0 && index < kMaximumOrder) {
    const Interval known = run.orders.value_or(Interval{index, index});
    run.orders = {std::min(known.first, index), std::max(known.last, index)};
  }
}

constexpr size_t kShownGaps = 8;

double RateHz(int64_t events, const LogSummary& summary) {
  return summary.duration_s() > 0 ? static_cast<double>(events) / summary.duration_s() : 0.0;
}

double Megabytes(int64_t bytes) {
  return 1e-6 * static_cast<double>(bytes);
}

std::string TimeText(int64_t utime) {
  constexpr int64_t kMicroseconds = 1'000'000;
  constexpr int64_t kYear3000 = 32'503'680'000;  // a limit, since a damaged event may have any time
  const int64_t seconds = std::clamp<int64_t>(utime / kMicroseconds, 0, kYear3000);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)),
                     std::max<int64_t>(utime, 0) % kMicroseconds / 1000);
}

std::string HeadText(const LogSummary& summary, const MergedEventLogs::Totals& totals) {
  std::string text = fmt::format("{} events, {:.1f} MB", summary.events(), Megabytes(totals.bytes));
  if (summary.events() > 0) {
    text += fmt::format(", {:.3f} s from {} on", summary.duration_s(), TimeText(summary.begin_utime()));
  }
  return fmt::format(
      "{}\n{} foreign messages, {} damaged ones; {} damaged bytes between events, {} bytes of a last event "
      "that was cut off\n",
      text, summary.foreign_messages(), summary.damaged_messages(), totals.damaged_bytes, totals.torn_bytes);
}

std::string ChannelTable(const LogSummary& summary) {
  std::string text = fmt::format("\n{:<26} {:<25} {:>9} {:>9} {:>10} {:>8}\n", "channel", "type", "events",
                                 "per s", "MB", "damaged");
  for (const auto& [name, channel] : summary.channels()) {
    text += fmt::format("{:<26} {:<25} {:>9} {:>9.1f} {:>10.3f} {:>8}\n", name, channel.type, channel.events,
                        RateHz(channel.events, summary), Megabytes(channel.message_bytes), channel.damaged);
  }
  return text;
}

std::string RunText(int64_t run_id, const RunTraffic& run) {
  std::string text = fmt::format("\nrun {}, configuration {:08x}", IdentifierText(run_id), run.config_hash);
  text += run.config_known ? " (complete)"
                           : fmt::format(" (only {} of its parts recorded)", run.announcements.parts());
  text += run.finished ? ", finished\n" : ", not finished\n";
  if (run.orders) {
    text += fmt::format("  orders {} .. {}, {} committed, {} without any transition\n", run.orders->first,
                        run.orders->last, run.committed_orders, run.orders_without_transitions());
  }
  const EpisodeCoverage& episodes = run.episodes;
  text += fmt::format(
      "  episodes: {} whole, {} partial; transitions: {}, {} missing, {} sent again; flown by {} actors\n",
      episodes.whole(), episodes.partial(), run.transitions(), run.missing_transitions(),
      run.repeated_transitions(), run.actors.size());
  if (run.learner_status) {
    text +=
        fmt::format("  learner, at the end: {} of {} episodes, {} updates\n", run.learner_status->episodes,
                    run.learner_status->total_episodes, run.learner_status->updates);
  }
  return text;
}

std::string ActorTable(const LogSummary& summary) {
  std::string text = fmt::format("\n{:<20} {:<20} {:>8} {:>9} {:>8}  {}\n", "actor", "host", "pid",
                                 "statuses", "missing", "numbers missing");
  for (const auto& [actor_id, actor] : summary.actors()) {
    std::string gaps;
    for (const Interval& gap : actor.sequences.Gaps(kShownGaps)) {
      gaps += fmt::format(" {}-{}", gap.first, gap.last);
    }
    text += fmt::format("{:<20} {:<20} {:>8} {:>9} {:>8} {}\n", actor_id, actor.host, actor.pid,
                        actor.statuses, actor.sequences.missing(), gaps);
  }
  return text;
}

OrderedJson RunJson(int64_t run_id, const RunTraffic& run) {
  OrderedJson json = {{"run_id", IdentifierText(run_id)},
                      {"config_hash", fmt::format("{:08x}", run.config_hash)},
                      {"config_known", run.config_known},
                      {"finished", run.finished},
                      {"first_order", run.orders ? OrderedJson(run.orders->first) : OrderedJson(nullptr)},
                      {"last_order", run.orders ? OrderedJson(run.orders->last) : OrderedJson(nullptr)},
                      {"committed_orders", run.committed_orders},
                      {"orders_without_transitions", run.orders_without_transitions()},
                      {"episodes_whole", run.episodes.whole()},
                      {"episodes_partial", run.episodes.partial()},
                      {"transitions", run.transitions()},
                      {"transitions_missing", run.missing_transitions()},
                      {"transitions_repeated", run.repeated_transitions()},
                      {"actors", run.actors}};
  if (run.learner_status) {
    json["learner_episodes"] = run.learner_status->episodes;
    json["learner_updates"] = run.learner_status->updates;
  }
  return json;
}

OrderedJson ActorJson(int64_t actor_id, const ActorTraffic& actor) {
  OrderedJson gaps = OrderedJson::array();
  for (const Interval& gap : actor.sequences.Gaps(kShownGaps)) {
    gaps.push_back({gap.first, gap.last});
  }
  return {{"actor_id", actor_id},
          {"host", actor.host},
          {"pid", actor.pid},
          {"statuses", actor.statuses},
          {"missing", actor.sequences.missing()},
          {"first_gaps", gaps}};
}

}  // namespace

int64_t RunTraffic::orders_without_transitions() const {
  const int64_t count = orders ? orders->last - orders->first + 1 : 0;
  return std::max<int64_t>(0, count - episodes.whole() - episodes.partial());
}

void LogSummary::Take(const LcmEvent& event) {
  begin_utime_ = events_ == 0 ? event.utime : std::min(begin_utime_, event.utime);
  end_utime_ = events_ == 0 ? event.utime : std::max(end_utime_, event.utime);
  ++events_;
  const char* type = PeekType(event.message);
  const bool sound = type == nullptr || TakeMessage(event.message);
  foreign_ += type == nullptr ? 1 : 0;
  damaged_ += sound ? 0 : 1;
  if (ChannelTraffic* channel = RecordOf(channels_, event.channel)) {
    NoteType(type, event.message, *channel);
    ++channel->events;
    channel->message_bytes += static_cast<int64_t>(event.message.size());
    channel->damaged += sound ? 0 : 1;
  }
}

/// Returns false if the message is damaged.
bool LogSummary::TakeMessage(std::span<const std::byte> message) {
  if (BeginsAs<weights_t>(message)) {
    return true;
  }
  if (BeginsAs<transitions_t>(message)) {
    const auto header = PeekTransitions(message);
    if (header) {
      Take(*header);
    }
    return header.has_value();
  }
  return decoder_.Decode(message, [this](const auto& decoded) { Take(decoded); }) ==
         MessageDecoder::Result::kDecoded;
}

/// Returns the record of this key, which is made if need be; null if there are too many.
template <class Records, class Key>
typename Records::mapped_type* LogSummary::RecordOf(Records& records, Key key) {
  if (const auto found = records.find(key); found != records.end()) {
    return &found->second;
  }
  if (records.size() >= kMaximumRecords) {
    ++beyond_limits_;
    return nullptr;
  }
  return &records.try_emplace(typename Records::key_type(key)).first->second;
}

RunTraffic* LogSummary::RunOf(RunIdentity identity) {
  RunTraffic* run = RecordOf(runs_, identity.run_id);
  if (run != nullptr) {
    run->config_hash = identity.config_hash;
  }
  return run;
}

void LogSummary::Take(const TransitionsHeader& header) {
  RunTraffic* run = RunOf(header.identity);
  const bool possible = header.order_index >= 0 && header.order_index < kMaximumOrder &&
                        header.first_transition >= 0 && header.transition_count > 0;
  if (run == nullptr || !possible) {
    return;
  }
  if (run->parts == 1 && header.first_field == 0) {
    run->episodes.Add(header.order_index, header.first_transition, header.transition_count,
                      header.ends_episode);
  } else if (run->parts > 1 && header.transition_count == 1 && header.first_field >= 0) {
    const int64_t part = std::min(header.first_field / run->fields_of_part, run->parts - 1);
    run->episodes.Add(header.order_index, header.first_transition * run->parts + part, 1,
                      header.ends_episode && part == run->parts - 1);
  }
  NoteOrder(header.order_index, *run);
  if (run->actors.size() < kMaximumRecords) {
    run->actors.insert(header.actor_id);
  }
}

void LogSummary::Take(const run_t& message) {
  if (RunTraffic* run = RunOf(IdentityOf(message))) {
    run->finished = run->finished || message.finished != 0;
    run->config_known = run->announcements.Add(message).has_value() || run->config_known;
  }
}

/// Decides how many messages a transition takes. Begins to count anew if that is more than one.
void LogSummary::Take(const world_t& message) {
  RunTraffic* run = RunOf(IdentityOf(message));
  const bool possible = message.state_size >= 1 && message.state_size <= kMaximumStateSize &&
                        message.action_count >= 1 && message.action_count <= kMaximumActions;
  if (run == nullptr || !possible || run->fields_of_part > 0) {
    return;
  }
  run->fields_of_part = LayoutOf(message.state_size, message.action_count).fields;
  run->parts = (message.state_size + run->fields_of_part - 1) / run->fields_of_part;
  if (run->parts > 1) {
    run->episodes = EpisodeCoverage();
  }
}

void LogSummary::Take(const orders_t& message) {
  if (RunTraffic* run = RunOf(IdentityOf(message))) {
    run->committed_orders = std::max(run->committed_orders, message.committed_orders);
    for (const order_t& order : message.orders) {
      NoteOrder(order.index, *run);
    }
  }
}

void LogSummary::Take(const actor_status_t& message) {
  ActorTraffic* actor = RecordOf(actors_, message.actor_id);
  if (actor == nullptr) {
    return;
  }
  actor->host = message.host;
  actor->pid = message.pid;
  ++actor->statuses;
  if (message.sequence >= 0 && message.sequence < kMaximumSequence) {
    actor->sequences.Add(message.sequence, message.sequence);
  }
}

void LogSummary::Take(const learner_status_t& message) {
  if (RunTraffic* run = RunOf(IdentityOf(message))) {
    run->learner_status = message;
  }
}

std::string LogSummaryText(const LogSummary& summary, const MergedEventLogs::Totals& totals) {
  std::string text = HeadText(summary, totals) + ChannelTable(summary);
  for (const auto& [run_id, run] : summary.runs()) {
    text += RunText(run_id, run);
  }
  if (!summary.actors().empty()) {
    text += ActorTable(summary);
  }
  return text;
}

std::string LogSummaryJson(const LogSummary& summary, const MergedEventLogs::Totals& totals) {
  OrderedJson json = {{"events", summary.events()},
                      {"bytes", totals.bytes},
                      {"begin_utime", summary.begin_utime()},
                      {"duration_s", summary.duration_s()},
                      {"damaged_bytes", totals.damaged_bytes},
                      {"torn_bytes", totals.torn_bytes},
                      {"foreign_messages", summary.foreign_messages()},
                      {"damaged_messages", summary.damaged_messages()},
                      {"beyond_limits", summary.beyond_limits()}};
  for (const char* list : {"channels", "runs", "actors"}) {
    json[list] = OrderedJson::array();
  }
  for (const auto& [name, channel] : summary.channels()) {
    json["channels"].push_back({{"channel", name},
                                {"type", channel.type},
                                {"events", channel.events},
                                {"per_s", RateHz(channel.events, summary)},
                                {"message_bytes", channel.message_bytes},
                                {"damaged", channel.damaged}});
  }
  for (const auto& [run_id, run] : summary.runs()) {
    json["runs"].push_back(RunJson(run_id, run));
  }
  for (const auto& [actor_id, actor] : summary.actors()) {
    json["actors"].push_back(ActorJson(actor_id, actor));
  }
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace fresco
