// The ledger: which orders are out, what of their results has arrived, and which episode comes next.
// Results may arrive in any order, in pieces, twice or not at all; episodes leave strictly by index,
// each exactly once. This is the only place that does any of these jobs. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "msgs/order.h"

namespace fresco {

/// An order and the episode that was flown for it.
struct CommittedEpisode {
  Order order;
  Episode episode;
};

class Ledger {
 public:
  /// `world` must outlive the ledger.
  Ledger(const World& world, MaskOptions mask_options) : world_(&world), mask_options_(mask_options) {}

  /// What so many orders take of memory, with their episodes.
  static int64_t BytesFor(const World& world, int64_t orders);

  /// Enters an order. The first one says where the sequence begins; CHECKs that indices come without gap.
  void Write(const Order& order);

  enum class Arrival {
    kAccepted,      ///< new transitions of an order that is out
    kCompleted,     ///< the order's last missing transitions
    kDuplicate,     ///< nothing new, or an order that is done
    kUnknownOrder,  ///< an order that was never written
    kInconsistent,  ///< does not follow from its actions in this world; all parts of the result are dropped
  };

  /// Keeps a part of a result that FromWire accepted. When an order's last transition has arrived, the
  /// episode is flown again from its actions; what is flown is what TakeNext hands out, if every part agrees
  /// with it.
  Arrival Add(const OrderResult& part);

  /// The episode of the lowest index if it is complete; it is done then.
  std::optional<CommittedEpisode> TakeNext();

  /// Indices below are done.
  int64_t committed() const { return committed_; }
  /// Orders out, by index from committed() on.
  int64_t in_flight() const { return static_cast<int64_t>(entries_.size()); }
  const Order& order(int64_t index) const { return entry(index).order; }
  bool IsComplete(int64_t index) const { return entry(index).episode.has_value(); }

 private:
  /// An order that is out, and what of its result has arrived.
  struct Entry {
    Order order;
    std::vector<OrderResult> parts = {};  // as they came; none once the episode is complete
    std::vector<int16_t> actions = {};    // by transition; kNotHere if it has not arrived
    int arrived = 0;                      // transitions
    int kept = 0;                         // transitions of all parts; more if these overlap
    int length = 0;                       // of the episode; 0 before the part that ends it has arrived
    std::optional<Episode> episode = {};  // once it is complete: flown again from its actions
  };
  static constexpr int16_t kNotHere = -1;

  const Entry& entry(int64_t index) const { return entries_[static_cast<size_t>(index - committed_)]; }
  bool Keep(const OrderResult& part, Entry& entry) const;
  std::optional<Episode> FlyAgain(const Entry& entry) const;

  const World* world_;
  MaskOptions mask_options_;
  bool begun_ = false;
  int64_t committed_ = 0;
  std::deque<Entry> entries_;
};

}  // namespace fresco
