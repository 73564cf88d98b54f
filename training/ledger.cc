#include "training/ledger.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/memory.h"
#include "training/episode_check.h"

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

Ledger::Arrival Ledger::Add(const Episode& run) {
  if (run.order_index < committed_) {
    return Arrival::kDuplicate;
  }
  if (run.order_index >= committed_ + in_flight()) {
    return Arrival::kUnknownOrder;
  }
  Entry& entry = entries_[static_cast<size_t>(run.order_index - committed_)];
  if (entry.episode || !Keep(run, entry)) {
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

/// Keeps the run if it brings a transition that was not here.
bool Ledger::Keep(const Episode& run, Entry& entry) const {
  entry.actions.resize(static_cast<size_t>(world_->maximum_transitions()), kNotHere);
  const int arrived_before = entry.arrived;
  auto action = entry.actions.begin() + run.first_transition;
  for (const int16_t flown : run.actions) {
    entry.arrived += *action == kNotHere ? 1 : 0;
    *action++ = flown;
  }
  if (entry.arrived == arrived_before) {
    return false;
  }
  if (run.outcome != Outcome::kFlying) {
    entry.length = run.first_transition + run.transitions();
  }
  entry.kept += run.transitions();
  entry.runs.push_back(run);
  return true;
}

/// The episode of the actions that have arrived; none if a run says anything else than what is flown.
std::optional<Episode> Ledger::FlyAgain(const Entry& entry) const {
  Episode flown;
  const std::span actions(entry.actions.data(), static_cast<size_t>(entry.length));
  if (!FlyActions(*world_, mask_options_, actions, flown) || flown.transitions() != entry.length) {
    return std::nullopt;
  }
  flown.order_index = entry.order.index;
  for (const Episode& run : entry.runs) {
    if (!IsPartOf(run, flown)) {
      return std::nullopt;
    }
    std::copy(run.td_errors.begin(), run.td_errors.end(), flown.td_errors.begin() + run.first_transition);
  }
  return flown;
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
