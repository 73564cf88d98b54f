#include "training/ledger.h"

#include <utility>

#include "core/error.h"

namespace fresco {

int64_t Ledger::BytesFor(const World& world, int64_t orders) {
  const int64_t of_check = 2 * LongestEpisodeBytes(world);  // a vector that grows may have twice the room
  return of_check + orders * (static_cast<int64_t>(sizeof(Entry)) + LongestEpisodeBytes(world) +
                              EpisodeAssembly::BytesFor(world));
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
  if (entry.parts == nullptr) {
    entry.parts = FreeAssembly();
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
  entry.parts->Clear();
  free_assemblies_.push_back(std::move(entry.parts));
  return entry.episode ? Arrival::kCompleted : Arrival::kInconsistent;
}

std::unique_ptr<EpisodeAssembly> Ledger::FreeAssembly() {
  if (free_assemblies_.empty()) {
    return std::make_unique<EpisodeAssembly>(*world_);
  }
  std::unique_ptr<EpisodeAssembly> assembly = std::move(free_assemblies_.back());
  free_assemblies_.pop_back();
  return assembly;
}

/// Whether the complete episode follows from its actions. If that can't be known, believes the actor.
bool Ledger::Follows(const Order& order, const Episode& episode) {
  if (!world_->description().repeatable) {
    return true;
  }
  if (!check_) {
    check_.emplace(*world_);
  }
  return FlyActions(order.seed, episode.actions, *check_) && SameBits(check_->episode(), episode);
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
