// The episodes of one run as LCM event logs hold them. The constructor reads the logs once, to know which
// episodes are whole; Take reads them once more, as far as it needs to. Each episode is put together by a
// ledger, so it counts only where everything of it follows from its actions in this world; what the logs
// hold twice or in pieces does no harm. Belongs to one thread.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "logs/log_messages.h"
#include "logs/logged_runs.h"
#include "msgs/order.h"
#include "training/ledger.h"

namespace fresco {

class LoggedEpisodes {
 public:
  /// `world` must outlive it; `mask_options` are those that the run flew with. Throws UsageError where a log
  /// can't be read.
  LoggedEpisodes(LogSource source, RunIdentity identity, const World& world, MaskOptions mask_options);

  /// The orders of which the whole episode is in the logs.
  const std::set<int64_t>& whole() const { return whole_; }
  /// Orders below the last whole one whose episode is not whole, as ranges (first, last), rising.
  std::vector<std::pair<int64_t, int64_t>> Missing() const;
  /// Of the whole ones those that were flown to train; the others evaluated, or their order was not recorded.
  std::vector<int64_t> Training() const;
  /// CRC-32C of a version of a network, as the learner sent it; none: not recorded.
  std::optional<uint32_t> WeightsCrc(NetworkKind kind, int32_t version) const;
  /// Of the logs.
  MergedEventLogs::Totals totals() const { return totals_; }
  /// Messages of the logs that were passed over for want of a tag of the key.
  int64_t refused() const { return refused_; }

  /// The whole episode of an order; CHECKs that it is one. The indices must rise from call to call. Throws
  /// Failure where the logs are not what they were.
  Episode Take(int64_t order_index);

 private:
  /// Puts episodes together; of bounded size whatever stands in a log.
  class Assembly {
   public:
    Assembly(const World& world, MaskOptions mask_options) : world_(&world), mask_options_(mask_options) {}
    /// Returns the episode where this completes it.
    std::optional<Episode> Add(const transitions_t& message);
    /// Drops what it has of orders below.
    void Forget(int64_t below) { open_.erase(open_.begin(), open_.lower_bound(below)); }

   private:
    const World* world_;
    MaskOptions mask_options_;
    Episode run_;
    std::map<int64_t, Ledger> open_;  // one order in each
  };

  bool IsOurs(RunIdentity identity) const { return identity == identity_; }
  void Survey();
  void TakeOrders(const orders_t& message);

  LogSource source_;
  RunIdentity identity_;
  const World* world_;
  MaskOptions mask_options_;
  std::set<int64_t> whole_;
  std::map<int64_t, OrderKind> kinds_;
  std::map<std::pair<NetworkKind, int32_t>, uint32_t> weights_crcs_;
  MergedEventLogs::Totals totals_;
  int64_t refused_ = 0;

  // Of Take.
  LogMessages messages_;
  Assembly assembly_;
  transitions_t transitions_{};
  std::map<int64_t, Episode> ahead_;  // whole, and not yet asked for
};

}  // namespace fresco
