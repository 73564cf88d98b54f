#include "training/ledger.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/memory.h"

namespace fresco {

int64_t Ledger::BytesFor(const World& world, int64_t orders) {
  const int64_t actions = world.maximum_transitions() * static_cast<int64_t>(sizeof(int16_t));
  const auto of_entry = static_cast<int64_t>(sizeof(Entry)) + LongestEpisodeBytes(world) + HeapBytes(actions);
  return orders * of_entry;
}

void Ledger::Write(const Order& order) {
  if (!std::exchange(begun_, true)) {
    committed_ = order.index;
  }
  FRESCO_CHECK(order.index == committed_ + in_flight());
  entries_.emplace_back().order = order;
}

Ledger::Arrival Ledger::Add(const OrderResult& part) {
  if (part.order_index < committed_) {
    return Arrival::kDuplicate;
  }
  if (part.order_index >= committed_ + in_flight()) {
    return Arrival::kUnknownOrder;
  }
  Entry& entry = entries_[static_cast<size_t>(part.order_index - committed_)];
  if (entry.episode || !Keep(part, entry)) {
    return Arrival::kDuplicate;
  }
  if (entry.kept > 2 * world_->maximum_transitions()) {  // no actor sends so many that overlap
    entry = {.order = entry.order};
    return Arrival::kInconsistent;
  }
  if (entry.length == 0 || entry.arrived < entry.length) {
    return Arrival::kAccepted;
  }
  entry = {.order = entry.order, .episode = FlyAgain(entry)};
  return entry.episode ? Arrival::kCompleted : Arrival::kInconsistent;
}

/// Keeps the part if it has a transition that has not arrived before. Returns whether it does.
bool Ledger::Keep(const OrderResult& part, Entry& entry) const {
  entry.actions.resize(static_cast<size_t>(world_->maximum_transitions()), kNotHere);
  const int arrived_before = entry.arrived;
  auto action = entry.actions.begin() + part.first_transition;
  for (const int16_t flown : part.episode.actions) {
    entry.arrived += *action == kNotHere ? 1 : 0;
    *action++ = flown;
  }
  if (entry.arrived == arrived_before) {
    return false;
  }
  if (part.episode.outcome != Outcome::kFlying) {
    entry.length = part.first_transition + part.episode.transitions();
  }
  entry.kept += part.episode.transitions();
  entry.parts.push_back(part);
  return true;
}

/// Flies the actions that have arrived. Returns none if a part differs from this flight.
std::optional<Episode> Ledger::FlyAgain(const Entry& entry) const {
  Episode flown;
  const std::span actions(entry.actions.data(), static_cast<size_t>(entry.length));
  const bool follows = FlyActions(*world_, mask_options_, actions, flown) &&
                       flown.transitions() == entry.length &&
                       std::all_of(entry.parts.begin(), entry.parts.end(), [&](const OrderResult& part) {
                         return IsPartOf(part.episode, part.first_transition, flown);
                       });
  return follows ? std::optional(std::move(flown)) : std::nullopt;
}

std::optional<CommittedEpisode> Ledger::TakeNext() {
  if (entries_.empty() || !entries_.front().episode) {
    return std::nullopt;
  }
  CommittedEpisode next{entries_.front().order, *std::move(entries_.front().episode)};
  entries_.pop_front();
  ++committed_;
  return next;
}

}  // namespace fresco
