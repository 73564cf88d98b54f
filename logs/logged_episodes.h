// Reads the episodes of one run from LCM event logs. The constructor reads the logs once, to find out which
// episodes are complete. Take reads them a second time, only as far as it needs. A Ledger (training/ledger.h)
// assembles each episode, so an episode counts only if it follows from its actions in this world, and it may
// be in the logs in pieces or twice. Only one thread may use an object.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "logs/coverage.h"
#include "logs/logged_runs.h"
#include "msgs/order.h"
#include "training/ledger.h"

namespace fresco {

class LoggedEpisodes {
 public:
  /// `world` is that of the recorded run and must outlive the object. Throws UsageError if a log can't be
  /// read.
  LoggedEpisodes(LogSource source, RunIdentity identity, const World& world);

  /// The indices of the orders whose episode is complete in the logs.
  const std::set<int64_t>& whole() const { return whole_; }
  /// The indices of the other orders, below the highest of whole(), as ascending ranges.
  std::vector<Interval> Missing() const;
  /// Those of whole() that are known to be training orders. The others are evaluations, or their order was
  /// not recorded.
  std::vector<int64_t> Training() const;
  /// The CRC-32C of a version of a network that the learner sent; none if it was not recorded.
  std::optional<uint32_t> WeightsCrc(NetworkKind kind, int32_t version) const;
  /// What was read of the logs.
  MergedEventLogs::Totals totals() const { return totals_; }
  /// The number of messages left out because they are not authenticated with the key.
  int64_t refused() const { return refused_; }

  /// Returns the complete episode of an order, with what its messages say of the order (index and seed);
  /// CHECKs that whole() has its index. The indices must ascend from call to call. Throws Failure if the logs
  /// have changed since the constructor read them.
  CommittedEpisode Take(int64_t order_index);

 private:
  /// Assembles episodes. Its memory is bounded, whatever is in a log.
  class Assembly {
   public:
    explicit Assembly(const World& world) : world_(&world) {}
    /// Adds the transitions of a message. Returns the episode if it is complete now.
    std::optional<CommittedEpisode> Add(const transitions_t& message);
    /// Drops the incomplete episodes of orders with a lower index.
    void Forget(int64_t below) { open_.erase(open_.begin(), open_.lower_bound(below)); }

   private:
    const World* world_;
    OrderResult part_;
    std::map<int64_t, Ledger> open_;  // incomplete episodes by order index, each in a ledger of its own
  };

  bool IsOurs(RunIdentity identity) const { return identity == identity_; }
  void Survey();
  void NoteOrders(const orders_t& message);

  LogSource source_;
  RunIdentity identity_;
  const World* world_;
  std::set<int64_t> whole_;
  std::map<int64_t, OrderKind> kinds_;
  std::map<std::pair<NetworkKind, int32_t>, uint32_t> weights_crcs_;
  MergedEventLogs::Totals totals_;
  int64_t refused_ = 0;

  // For Take.
  LogMessages messages_;
  Assembly assembly_;
  transitions_t transitions_{};
  std::map<int64_t, CommittedEpisode> ahead_;  // complete episodes that Take was not asked for yet
};

}  // namespace fresco
