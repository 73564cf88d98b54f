#include "learner/roster.h"

#include <fmt/format.h>

#include <algorithm>

namespace fresco {
namespace {

constexpr int64_t kGoneUs = 3'000'000;  // an actor that says nothing for so long is forgotten
constexpr int64_t kSilentUs = 350'000;  // several statuses missed: it gets no orders, its own go to others
constexpr int64_t kAnnounceAgainUs = 60'000;  // an order whose result is not here is repeated
constexpr int64_t kSoonestLateUs = 150'000;
constexpr double kLateFactor = 4;  // late: several times the usual latency
constexpr int kLongestPatience = 8;

}  // namespace

void Roster::Hear(const actor_status_t& status, int64_t now_us) {
  ActorRecord& actor = actors_[status.actor_id];
  actor.last_heard_us = now_us;
  actor.capacity = std::max(1, status.capacity);
  actor.pid = status.pid;
  actor.host = status.host;
  actor.transitions_per_s = status.transitions_per_s;
}

void Roster::Completed(int64_t index, int64_t now_us) {
  const auto found = assignments_.find(index);
  if (found == assignments_.end()) {
    return;
  }
  constexpr double kShare = 0.05;
  latency_us_ += kShare * (static_cast<double>(now_us - found->second.assigned_us) - latency_us_);
  --open_orders_[found->second.actor_id];
  assignments_.erase(found);
}

void Roster::ForgetGoneActors(int64_t now_us) {
  std::erase_if(actors_, [&](const auto& entry) { return now_us - entry.second.last_heard_us > kGoneUs; });
}

bool Roster::IsSilent(int64_t actor_id, int64_t now_us) const {
  const auto found = actors_.find(actor_id);
  return found == actors_.end() || now_us - found->second.last_heard_us > kSilentUs;
}

int64_t Roster::Choose(int64_t except, int64_t now_us) const {
  int64_t best = 0;
  double best_load = 0;
  for (const auto& [id, actor] : actors_) {
    const auto open = open_orders_.find(id);
    const double load = (open == open_orders_.end() ? 0.0 : open->second) / actor.capacity;
    if (id != except && !IsSilent(id, now_us) && (best == 0 || load < best_load)) {
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

std::vector<order_t> Roster::DueOrders(const Ledger& ledger, int64_t now_us) {
  ForgetGoneActors(now_us);
  std::vector<order_t> due;
  for (int64_t index = ledger.committed(); index < ledger.committed() + ledger.in_flight(); ++index) {
    if (ledger.IsComplete(index)) {
      continue;
    }
    const auto [found, is_new] = assignments_.try_emplace(index);
    Assignment& assignment = found->second;
    if (assignment.actor_id == 0 || IsLate(assignment, now_us)) {
      const int64_t chosen = Choose(assignment.actor_id, now_us);
      if (chosen == 0) {
        continue;
      }
      if (assignment.actor_id != 0) {
        --open_orders_[assignment.actor_id];
        ++assignment.attempt;
        ++late_orders_;
      }
      ++open_orders_[chosen];
      assignment.actor_id = chosen;
      assignment.assigned_us = now_us;
      assignment.announced_us = 0;
    }
    if (assignment.announced_us == 0 || now_us - assignment.announced_us >= kAnnounceAgainUs) {
      assignment.announced_us = now_us;
      due.push_back(ToWire(ledger.order(index), assignment.actor_id, assignment.attempt));
    }
  }
  return due;
}

std::string Roster::Awaited(int64_t index, int64_t now_us) const {
  if (actors_.empty()) {
    return "an actor to join";
  }
  const auto found = assignments_.find(index);
  if (found == assignments_.end() || IsSilent(found->second.actor_id, now_us)) {
    return fmt::format("an actor for order {}", index);
  }
  const ActorRecord& actor = actors_.at(found->second.actor_id);
  return fmt::format("{} (pid {}): order {} for {:.1f} s", actor.host, actor.pid, index,
                     static_cast<double>(now_us - found->second.assigned_us) * 1e-6);
}

}  // namespace fresco
