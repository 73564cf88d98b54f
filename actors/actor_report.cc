// What an actor tells the learner and people.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "actors/actor.h"
#include "core/identifier.h"

namespace fresco {
namespace {

constexpr size_t kLongestList = 32;

double Milliseconds(int64_t us) {
  return static_cast<double>(us) * 1e-3;
}

std::string Ranges(const std::vector<chunk_range_t>& ranges) {
  std::string text;
  for (const chunk_range_t& range : ranges) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", range.network == 0 ? "current" : "target",
                        range.version);
  }
  return text.empty() ? "none" : text;
}

std::string Text(const RejectedMessages& rejected) {
  std::string causes;
  for (const auto& [count, cause] : {std::pair{rejected.malformed, "malformed"},
                                     {rejected.foreign, "foreign"},
                                     {rejected.stale, "stale"},
                                     {rejected.inconsistent, "inconsistent"},
                                     {rejected.unauthenticated, "unauthenticated"}}) {
    if (count > 0) {
      causes += fmt::format("{}{} {}", causes.empty() ? ": " : ", ", count, cause);
    }
  }
  return fmt::format("{} rejected{}", rejected.total(), causes);
}

}  // namespace

void Actor::MeasureRate(int64_t now_us) {
  constexpr int64_t kRatePeriodUs = 1'000'000;
  if (now_us - rate_since_us_ >= kRatePeriodUs) {
    const double seconds = static_cast<double>(now_us - rate_since_us_) * 1e-6;
    transitions_per_s_ =
        static_cast<float>(static_cast<double>(totals_.transitions - rate_transitions_) / seconds);
    rate_since_us_ = now_us;
    rate_transitions_ = totals_.transitions;
  }
}

actor_status_t Actor::Status(int64_t now_us) {
  MeasureRate(now_us);
  actor_status_t status{};
  status.actor_id = options_.actor_id;
  status.pid = options_.pid;
  status.host = options_.host.substr(0, kMaximumHostBytes);
  status.arithmetic_fingerprint = arithmetic_fingerprint_;
  status.episodes = totals_.episodes;
  status.transitions = totals_.transitions;
  status.resent_episodes = totals_.resent_episodes;
  status.rejected_messages = totals().rejected.total();
  status.transitions_per_s = transitions_per_s_;
  status.weights_latency_ms = static_cast<float>(Milliseconds(totals_.longest_assembly_us));
  status.oldest_open_order = -1;
  if (session_ != nullptr) {
    AddSession(*session_, now_us, status);
  }
  return status;
}

int64_t Actor::OldestOpenOrder(const Session& session) {
  std::vector<int64_t> open = session.flyer.OrderIndices();
  std::erase_if(open, [&](int64_t index) { return index < session.committed; });
  if (!session.waiting.empty()) {
    open.push_back(session.waiting.begin()->first);
  }
  return open.empty() ? -1 : *std::min_element(open.begin(), open.end());
}

void Actor::AddSession(Session& session, int64_t now_us, actor_status_t& status) const {
  status.capacity = options_.capacity.value_or(session.experiment.run().environments_per_actor());
  status.open_orders = static_cast<int32_t>(session.waiting.size()) + session.flyer.open_flights();
  status.oldest_open_order = OldestOpenOrder(session);
  status.held = session.store.HeldVersions();
  status.missing = session.store.MissingRanges(now_us);
  status.held_count = static_cast<int32_t>(status.held.size());
  status.missing_count = static_cast<int32_t>(status.missing.size());
}

ActorTotals Actor::totals() const {
  ActorTotals totals = totals_;
  totals.rejected.malformed = bus_.malformed_messages();
  totals.rejected.unauthenticated = bus_.unauthenticated_messages();
  return totals;
}

std::string Actor::Description() const {
  return fmt::format(
      "actor {}: {} run(s) served, {} episodes, {} transitions, {} sent again, {} versions completed, "
      "the slowest within {:.1f} ms, {} messages received, {}",
      IdentifierText(options_.actor_id), totals_.runs, totals_.episodes, totals_.transitions,
      totals_.resent_episodes, totals_.completed_versions, Milliseconds(totals_.longest_assembly_us),
      totals_.received_messages, Text(totals().rejected));
}

std::string Actor::WaitsFor(const Order& order) const {
  std::string text;
  for (const NetworkVersion& version : {NetworkVersion{NetworkKind::kCurrent, order.current_version},
                                        NetworkVersion{NetworkKind::kTarget, order.target_version}}) {
    if (const int missing = session_->store.MissingChunks(version); missing > 0) {
      text +=
          fmt::format("{}{} network {} ({} chunks missing)", text.empty() ? "" : " and ",
                      version.first == NetworkKind::kCurrent ? "current" : "target", version.second, missing);
    }
  }
  return text.empty() ? "room" : text;
}

std::string Actor::StateText() const {
  std::string text = "state\n  " + Description();
  if (session_ == nullptr) {
    return text + "\n  waits for a run";
  }
  const Session& session = *session_;
  text += fmt::format("\n  run {}, last heard of {:.1f} s ago\n  {} orders flying, {} flown and kept",
                      IdentifierText(session.identity.run_id),
                      Milliseconds(attention_.now_us() - session.last_heard_us) * 1e-3,
                      session.flyer.open_flights(), session.flown.size());
  size_t lines = 0;
  for (const auto& [index, order] : session.waiting) {
    if (++lines > kLongestList) {
      text += fmt::format("\n  and {} orders more", session.waiting.size() - kLongestList);
      break;
    }
    text += fmt::format("\n  order {} waits for {}", index, WaitsFor(order));
  }
  return text + "\n  networks held: " + Ranges(session.store.HeldVersions());
}

}  // namespace fresco
