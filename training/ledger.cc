#include "training/ledger.h"

#include <utility>

#include "core/error.h"

namespace fresco {

int64_t Ledger::BytesFor(const World& world, int64_t orders) {
  return orders * (static_cast<int64_t>(sizeof(Entry)) + EpisodeAssembly::BytesFor(world));
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
  if (entry.episode) {
    return Arrival::kDuplicate;
  }
  if (!entry.parts) {
    entry.parts.emplace(*world_);
  }
  const auto arrival =
      part.seed == entry.order.seed ? entry.parts->Add(part) : EpisodeAssembly::Arrival::kContradiction;
  if (arrival == EpisodeAssembly::Arrival::kNothingNew) {
    return Arrival::kDuplicate;
  }
  if (arrival == EpisodeAssembly::Arrival::kNew && !entry.parts->complete()) {
    return Arrival::kAccepted;
  }
  if (arrival == EpisodeAssembly::Arrival::kNew && Follows(entry.order, entry.parts->episode())) {
    entry.episode = entry.parts->episode();
    entry.episode->seed = entry.order.seed;
  }
  entry.parts.reset();
  return entry.episode ? Arrival::kCompleted : Arrival::kInconsistent;
}

/// Whether the complete episode follows from its actions. Where that can't be known, believes the actor.
bool Ledger::Follows(const Order& order, const Episode& episode) const {
  if (!world_->description().repeatable) {
    return true;
  }
  Episode flown;
  return FlyActions(*world_, order.seed, episode.actions, flown) && SameBits(flown, episode);
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
