// The part of Roster that writes texts for people: which actor is awaited, and what it is doing.
#include <fmt/format.h>

#include <algorithm>

#include "core/identifier.h"
#include "learner/roster.h"

namespace fresco {
namespace {

constexpr size_t kLongestList = 32;

double Seconds(int64_t us) {
  return static_cast<double>(us) * 1e-6;
}

std::string NameOf(const ActorRecord& actor) {
  return fmt::format("{} (pid {})", actor.host, actor.pid);
}

/// "; it lacks current network 7 (3 chunks missing)", by the actor's last status; empty if it lacks nothing.
std::string LackedNetworks(const ActorRecord& actor, const Order& order) {
  int64_t missing_of[2] = {0, 0};  // by kind
  for (const chunk_range_t& range : actor.missing) {
    const bool target = range.network != 0;
    missing_of[target] += range.version == (target ? order.target_version : order.current_version)
                              ? std::max(0, range.count)
                              : 0;
  }
  std::string text;
  for (const bool target : {false, true}) {
    if (missing_of[target] > 0) {
      text += fmt::format("{}{} network {} ({} chunks missing)", text.empty() ? "; it lacks " : " and ",
                          target ? "target" : "current",
                          target ? order.target_version : order.current_version, missing_of[target]);
    }
  }
  return text;
}

}  // namespace

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
