#include "learner/roster.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/identifier.h"
#include "msgs/protocol_times.h"
#include "msgs/weights_codec.h"

namespace fresco {
namespace {

constexpr int64_t kSoonestLateUs = 150'000;  // no order is late before
constexpr double kLateFactor = 4;            // an order is late after so many times the usual latency
constexpr int kLongestPatience = 8;          // each attempt may take longer, up to this factor
constexpr int32_t kLargestCapacity = 4096;
constexpr size_t kLongestList = 32;  // of actors in a text

double Seconds(int64_t us) {
  return static_cast<double>(us) * 1e-6;
}

std::string NameOf(const ActorRecord& actor) {
  return fmt::format("{} (pid {})", actor.host, actor.pid);
}

/// "; it lacks current network 7 (3 chunks missing)", by the actor's last status; empty if it lacks nothing.
std::string LackedNetworks(const ActorRecord& actor, const Order& order) {
  std::string text;
  for (const NetworkVersion& version : VersionsOf(order)) {
    int64_t missing = 0;
    for (const chunk_range_t& range : actor.missing) {
      missing += VersionOf(range) == version ? std::max(0, range.count) : 0;
    }
    if (missing > 0) {
      text += fmt::format("{}{} network {} ({} chunks missing)", text.empty() ? "; it lacks " : " and ",
                          Name(version.kind), version.number, missing);
    }
  }
  return text;
}

}  // namespace

Roster::Hearing Roster::Hear(const actor_status_t& status, int64_t now_us) {
  if (!actors_.contains(status.actor_id) && !MakeRoom(now_us)) {
    return Hearing::kCrowdedOut;
  }
  ActorRecord& actor = actors_[status.actor_id];
  if (status.sequence <= actor.sequence) {
    return Hearing::kStale;
  }
  if (actor.sequence >= 0) {
    processor_us_ += std::max<int64_t>(0, status.processor_us - actor.processor_us);
  }
  actor.processor_us = status.processor_us;
  actor.last_heard_us = now_us;
  actor.sequence = status.sequence;
  actor.capacity = std::clamp(status.capacity, 1, kLargestCapacity);
  actor.pid = status.pid;
  actor.host = status.host.substr(0, kMaximumHostBytes);
  actor.oldest_open_order = status.oldest_open_order;
  actor.transitions_per_s = status.transitions_per_s;
  actor.missing = status.missing;
  return Hearing::kHeard;
}

/// Returns whether there is room for a new actor; forgets the longest gone one if need be. An actor that is
/// gone is otherwise remembered, so that repeated statuses of it are still known to be stale.
bool Roster::MakeRoom(int64_t now_us) {
  if (actors_.size() < kMaximumActors) {
    return true;
  }
  const auto longest_gone = std::min_element(
      actors_.begin(), actors_.end(),
      [](const auto& a, const auto& b) { return a.second.last_heard_us < b.second.last_heard_us; });
  const bool gone = now_us - longest_gone->second.last_heard_us > kGoneActorUs;
  if (gone) {
    actors_.erase(longest_gone);
  }
  return gone;
}

void Roster::Completed(int64_t index, int64_t actor_id, int64_t now_us) {
  if (const auto actor = actors_.find(actor_id); actor != actors_.end()) {
    actor->second.late_orders = 0;
  }
  const auto found = assignments_.find(index);
  if (found == assignments_.end()) {
    return;
  }
  if (found->second.actor_id != 0) {
    constexpr double kShare = 0.05;
    latency_us_ += kShare * (static_cast<double>(now_us - found->second.assigned_us) - latency_us_);
    Release(found->second.actor_id);
  }
  assignments_.erase(found);
}

int Roster::live_actors(int64_t now_us) const {
  return static_cast<int>(std::count_if(actors_.begin(), actors_.end(), [&](const auto& entry) {
    return now_us - entry.second.last_heard_us <= kGoneActorUs;
  }));
}

bool Roster::IsSilent(int64_t actor_id, int64_t now_us) const {
  const auto found = actors_.find(actor_id);
  return found == actors_.end() || now_us - found->second.last_heard_us > kSilentActorUs;
}

bool Roster::AllSilent(int64_t now_us) const {
  return std::all_of(actors_.begin(), actors_.end(),
                     [&](const auto& entry) { return IsSilent(entry.first, now_us); });
}

int64_t Roster::Choose(int64_t except, int64_t now_us) const {
  int64_t best = 0;
  std::pair<double, int64_t> best_load;
  for (const auto& [id, actor] : actors_) {
    if (id == except || IsSilent(id, now_us)) {
      continue;
    }
    const auto open = open_orders_.find(id);
    // An actor that owes late results gets fewer orders, but still some: it or its network may just be slow.
    const int orders = (open == open_orders_.end() ? 0 : open->second) + actor.late_orders;
    if (orders >= kOrdersPerEnvironment * actor.capacity) {
      continue;
    }
    const std::pair load(static_cast<double>(orders) / actor.capacity, actor.last_assigned);
    if (best == 0 || load < best_load) {
      best = id;
      best_load = load;
    }
  }
  return best != 0 || IsSilent(except, now_us) ? best : except;
}

bool Roster::IsLate(const Assignment& assignment, int64_t now_us) const {
  const double patience_us = std::max<double>(kSoonestLateUs, kLateFactor * latency_us_);
  return IsSilent(assignment.actor_id, now_us) ||
         static_cast<double>(now_us - assignment.assigned_us) >
             patience_us * std::min(1 + assignment.attempt, kLongestPatience);
}

void Roster::Assign(Assignment& assignment, int64_t actor_id, int64_t now_us) {
  if (assignment.actor_id != 0) {
    Release(assignment.actor_id);
    if (!IsSilent(assignment.actor_id, now_us)) {
      ActorRecord& actor = actors_.at(assignment.actor_id);
      actor.late_orders = std::min(actor.late_orders + 1, actor.capacity);
    }
    ++assignment.attempt;
    ++late_orders_;
  }
  ++open_orders_[actor_id];
  actors_.at(actor_id).last_assigned = ++assigned_;
  assignment.actor_id = actor_id;
  assignment.assigned_us = now_us;
  assignment.announced_us = 0;
}

void Roster::Release(int64_t actor_id) {
  const auto open = open_orders_.find(actor_id);
  if (--open->second == 0) {
    open_orders_.erase(open);
  }
}

std::vector<order_t> Roster::DueOrders(const Ledger& ledger, int64_t now_us) {
  std::vector<order_t> due;
  if (AllSilent(now_us)) {
    return due;
  }
  for (int64_t index = ledger.committed(); index < ledger.committed() + ledger.in_flight(); ++index) {
    if (ledger.IsComplete(index)) {
      continue;
    }
    Assignment& assignment = assignments_[index];
    if (assignment.actor_id == 0 || IsLate(assignment, now_us)) {
      const int64_t chosen = Choose(assignment.actor_id, now_us);
      if (chosen == 0) {
        continue;
      }
      Assign(assignment, chosen, now_us);
    }
    if (assignment.announced_us == 0 || now_us - assignment.announced_us >= kOrderRepeatPeriodUs) {
      assignment.announced_us = now_us;
      due.push_back(ToWire(ledger.order(index), assignment.actor_id, assignment.attempt));
    }
  }
  return due;
}

std::string Roster::Awaited(const Order& order, int64_t now_us) const {
  if (actors_.empty()) {
    return "an actor to join";
  }
  if (AllSilent(now_us)) {
    return "an actor: " + LastHeard(now_us);
  }
  const auto found = assignments_.find(order.index);
  if (found == assignments_.end() || IsSilent(found->second.actor_id, now_us)) {
    return fmt::format("an actor for order {}", order.index);
  }
  const ActorRecord& actor = actors_.at(found->second.actor_id);
  const std::string lacked = LackedNetworks(actor, order);
  const bool flying = actor.oldest_open_order == order.index;
  return fmt::format("{}: order {} for {:.1f} s{}", NameOf(actor), order.index,
                     Seconds(now_us - found->second.assigned_us),
                     !lacked.empty() ? lacked
                     : flying        ? "; it has the order and is flying"
                                     : "; it has not got the order yet, or the result has not arrived");
}

std::string Roster::LastHeard(int64_t now_us) const {
  const auto newest = std::max_element(actors_.begin(), actors_.end(), [](const auto& a, const auto& b) {
    return a.second.last_heard_us < b.second.last_heard_us;
  });
  const std::string last = fmt::format("{} was last heard of {:.1f} s ago", NameOf(newest->second),
                                       Seconds(now_us - newest->second.last_heard_us));
  return actors_.size() == 1 ? last : fmt::format("all {} are silent, {}", actors_.size(), last);
}

std::string Roster::StateText(int64_t now_us) const {
  std::string text;
  std::map<int64_t, std::string> orders;  // by actor
  for (const auto& [index, assignment] : assignments_) {
    orders[assignment.actor_id] += fmt::format(" {}", index);
  }
  size_t lines = 0;
  for (const auto& [id, actor] : actors_) {
    if (++lines > kLongestList) {
      return text + fmt::format("\n  and {} more actors", actors_.size() - kLongestList);
    }
    const std::string flies = orders.contains(id) ? "orders" + orders.at(id) : "no order";
    text += fmt::format("\n  actor {} {}: heard of {:.1f} s ago, {:.0f} transitions/s, {} late, {}",
                        IdentifierText(id), NameOf(actor), Seconds(now_us - actor.last_heard_us),
                        actor.transitions_per_s, actor.late_orders, flies.substr(0, 200));
  }
  return text;
}

}  // namespace fresco
