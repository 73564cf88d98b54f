#include "training/ledger.h"

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "core/memory_need.h"
#include "training/episode_check.h"

namespace fresco {

int64_t Ledger::BytesFor(const World& world, int64_t orders) {
  const auto of_entry = static_cast<int64_t>(sizeof(Entry) - sizeof(Episode)) + LongestEpisodeBytes(world) +
                        HeapBytes(world.maximum_transitions());
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
  if (entry.complete) {
    return Arrival::kDuplicate;
  }
  if (entry.received.empty()) {
    Prepare(entry);
  }
  if (!Merge(run, entry)) {
    return Arrival::kDuplicate;
  }
  if (entry.length == 0 || entry.received_count < entry.length) {
    return Arrival::kAccepted;
  }
  Trim(entry);
  if (!FollowsFromItsActions(*world_, mask_options_, entry.episode)) {
    const Order order = entry.order;
    entry = Entry{};
    entry.order = order;
    return Arrival::kInconsistent;
  }
  entry.complete = true;
  return Arrival::kCompleted;
}

void Ledger::Prepare(Entry& entry) const {
  const auto length = static_cast<size_t>(world_->maximum_transitions());
  entry.received.assign(length, 0);
  entry.episode.order_index = entry.order.index;
  entry.episode.states.resize(length + 1);
  entry.episode.actions.resize(length);
  entry.episode.rewards.resize(length);
  entry.episode.td_errors.resize(length);
  entry.episode.next_masks.resize(length * static_cast<size_t>(MaskSize(*world_)));
}

bool Ledger::Merge(const Episode& run, Entry& entry) const {
  const auto first = static_cast<size_t>(run.first_transition);
  const auto count = static_cast<size_t>(run.transitions());
  const auto mask_size = static_cast<size_t>(MaskSize(*world_));
  bool news = false;
  for (size_t i = 0; i < count; ++i) {
    if (entry.received[first + i] == 0) {
      entry.received[first + i] = 1;
      ++entry.received_count;
      news = true;
    }
  }
  if (!news) {
    return false;
  }
  std::copy(run.states.begin(), run.states.end(), entry.episode.states.begin() + run.first_transition);
  std::copy(run.actions.begin(), run.actions.end(), entry.episode.actions.begin() + run.first_transition);
  std::copy(run.rewards.begin(), run.rewards.end(), entry.episode.rewards.begin() + run.first_transition);
  std::copy(run.td_errors.begin(), run.td_errors.end(),
            entry.episode.td_errors.begin() + run.first_transition);
  std::copy(run.next_masks.begin(), run.next_masks.end(),
            entry.episode.next_masks.data() + first * mask_size);
  if (run.outcome != Outcome::kFlying) {
    entry.length = static_cast<int>(first + count);
    entry.episode.outcome = run.outcome;
  }
  return true;
}

void Ledger::Trim(Entry& entry) const {
  const auto length = static_cast<size_t>(entry.length);
  entry.episode.states.resize(length + 1);
  entry.episode.actions.resize(length);
  entry.episode.rewards.resize(length);
  entry.episode.td_errors.resize(length);
  entry.episode.next_masks.resize(length * static_cast<size_t>(MaskSize(*world_)));
}

std::optional<CommittedEpisode> Ledger::TakeNext() {
  if (entries_.empty() || !entries_.front().complete) {
    return std::nullopt;
  }
  CommittedEpisode next{entries_.front().order, std::move(entries_.front().episode)};
  entries_.pop_front();
  ++committed_;
  return next;
}

}  // namespace fresco
