#include "logs/logged_episodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "core/error.h"

namespace fresco {
namespace {

/// More than any run has in flight. If more are open, the oldest will not become complete.
constexpr size_t kMaximumOpenEpisodes = 8192;

}  // namespace

std::optional<CommittedEpisode> LoggedEpisodes::Assembly::Add(const transitions_t& message) {
  if (!FromWire(*world_, message, part_)) {
    return std::nullopt;
  }
  auto [entry, is_new] = open_.try_emplace(part_.order_index, *world_);
  Ledger& ledger = entry->second;
  if (is_new) {
    Order order;
    order.index = part_.order_index;
    order.seed = part_.seed;
    ledger.Write(order);
  }
  if (ledger.Add(part_) == Ledger::Arrival::kCompleted) {
    std::optional<CommittedEpisode> complete = ledger.TakeNext();
    open_.erase(entry);
    return complete;
  }
  if (open_.size() > kMaximumOpenEpisodes) {
    open_.erase(open_.begin());
  }
  return std::nullopt;
}

LoggedEpisodes::LoggedEpisodes(LogSource source, RunIdentity identity, const World& world)
    : source_(std::move(source)), identity_(identity), world_(&world), messages_(source_), assembly_(world) {
  Survey();
}

void LoggedEpisodes::Survey() {
  LogMessages messages(source_);
  Assembly assembly(*world_);
  orders_t orders{};
  weights_t weights{};
  while (const auto message = messages.Next()) {
    if (message->DecodeAs(transitions_) && IsOurs(IdentityOf(transitions_)) &&
        !whole_.contains(transitions_.order_index)) {
      if (assembly.Add(transitions_)) {
        whole_.insert(transitions_.order_index);
      }
    } else if (message->DecodeAs(orders) && IsOurs(IdentityOf(orders))) {
      NoteOrders(orders);
    } else if (message->DecodeAs(weights) && IsOurs(IdentityOf(weights))) {
      // Only the channel says which of the two networks a chunk belongs to.
      const auto kind = message->channel.ends_with("_TARGET") ? NetworkKind::kTarget : NetworkKind::kCurrent;
      weights_crcs_[{kind, weights.version}] = static_cast<uint32_t>(weights.crc32c);
    }
  }
  totals_ = messages.totals();
  refused_ = messages.refused();
}

void LoggedEpisodes::NoteOrders(const orders_t& message) {
  for (const order_t& wire : message.orders) {
    Order order;
    if (FromWire(wire, order)) {
      kinds_[order.index] = order.kind;
    }
  }
}

std::vector<Interval> LoggedEpisodes::Missing() const {
  constexpr size_t kAll = std::numeric_limits<size_t>::max();
  IntervalSet whole(kAll);
  whole.Add(-1, -1);  // so that the orders before the first whole episode are a gap, too
  for (const int64_t index : whole_) {
    whole.Add(index, index);
  }
  return whole.Gaps(kAll);
}

std::vector<int64_t> LoggedEpisodes::Training() const {
  std::vector<int64_t> training;
  std::copy_if(whole_.begin(), whole_.end(), std::back_inserter(training), [this](int64_t index) {
    const auto kind = kinds_.find(index);
    return kind != kinds_.end() && kind->second == OrderKind::kTrain;
  });
  return training;
}

std::optional<uint32_t> LoggedEpisodes::WeightsCrc(NetworkKind kind, int32_t version) const {
  const auto found = weights_crcs_.find({kind, version});
  return found == weights_crcs_.end() ? std::nullopt : std::optional(found->second);
}

CommittedEpisode LoggedEpisodes::Take(int64_t order_index) {
  FRESCO_CHECK(whole_.contains(order_index));
  ahead_.erase(ahead_.begin(), ahead_.lower_bound(order_index));
  assembly_.Forget(order_index);
  while (!ahead_.contains(order_index)) {
    const auto message = messages_.Next();
    if (!message) {
      throw Failure(fmt::format("{}: the log was changed while it was read", source_.paths.front().string()));
    }
    if (message->DecodeAs(transitions_) && IsOurs(IdentityOf(transitions_)) &&
        transitions_.order_index >= order_index) {
      if (auto complete = assembly_.Add(transitions_)) {
        ahead_.try_emplace(complete->order.index, std::move(*complete));
      }
    }
  }
  const auto found = ahead_.find(order_index);
  CommittedEpisode episode = std::move(found->second);
  ahead_.erase(found);
  return episode;
}

}  // namespace fresco
