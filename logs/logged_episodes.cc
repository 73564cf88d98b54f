#include "logs/logged_episodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/error.h"

namespace fresco {
namespace {

/// More than any run has in flight. If more are open, the oldest will not become complete.
constexpr size_t kMaximumOpenEpisodes = 8192;

}  // namespace

std::optional<Episode> LoggedEpisodes::Assembly::Add(const transitions_t& message) {
  if (!ToEpisodeRun(*world_, message, run_)) {
    return std::nullopt;
  }
  auto [entry, is_new] = open_.try_emplace(run_.order_index, *world_, mask_options_);
  Ledger& ledger = entry->second;
  if (is_new) {
    ledger.Write(Order{run_.order_index});
  }
  if (ledger.Add(run_) == Ledger::Arrival::kCompleted) {
    std::optional<CommittedEpisode> whole = ledger.TakeNext();
    open_.erase(entry);
    return whole ? std::optional(std::move(whole->episode)) : std::nullopt;
  }
  if (open_.size() > kMaximumOpenEpisodes) {
    open_.erase(open_.begin());
  }
  return std::nullopt;
}

LoggedEpisodes::LoggedEpisodes(LogSource source, RunIdentity identity, const World& world,
                               MaskOptions mask_options)
    : source_(std::move(source)),
      identity_(identity),
      world_(&world),
      mask_options_(mask_options),
      messages_(source_),
      assembly_(world, mask_options) {
  Survey();
}

void LoggedEpisodes::Survey() {
  LogMessages messages(source_);
  Assembly assembly(*world_, mask_options_);
  orders_t orders{};
  weights_t weights{};
  while (const auto message = messages.Next()) {
    if (message->DecodeAs(transitions_) && IsOurs(IdentityOf(transitions_)) &&
        !whole_.contains(transitions_.order_index)) {
      if (assembly.Add(transitions_)) {
        whole_.insert(transitions_.order_index);
      }
    } else if (message->DecodeAs(orders) && IsOurs(IdentityOf(orders))) {
      TakeOrders(orders);
    } else if (message->DecodeAs(weights) && IsOurs(IdentityOf(weights))) {
      // Only the channel says which of the two networks a chunk belongs to.
      const auto kind = message->channel.ends_with("_TARGET") ? NetworkKind::kTarget : NetworkKind::kCurrent;
      weights_crcs_[{kind, weights.version}] = static_cast<uint32_t>(weights.crc32c);
    }
  }
  totals_ = messages.totals();
  refused_ = messages.refused();
}

void LoggedEpisodes::TakeOrders(const orders_t& message) {
  for (const order_t& wire : message.orders) {
    Order order;
    if (FromWire(wire, order)) {
      kinds_[order.index] = order.kind;
    }
  }
}

std::vector<std::pair<int64_t, int64_t>> LoggedEpisodes::Missing() const {
  std::vector<std::pair<int64_t, int64_t>> missing;
  int64_t next = 0;
  for (const int64_t index : whole_) {
    if (index > next) {
      missing.emplace_back(next, index - 1);
    }
    next = index + 1;
  }
  return missing;
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

Episode LoggedEpisodes::Take(int64_t order_index) {
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
      if (auto episode = assembly_.Add(transitions_)) {
        ahead_.try_emplace(episode->order_index, std::move(*episode));
      }
    }
  }
  const auto found = ahead_.find(order_index);
  Episode episode = std::move(found->second);
  ahead_.erase(found);
  return episode;
}

}  // namespace fresco
