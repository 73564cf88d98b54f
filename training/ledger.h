// The ledger knows which orders are in flight, what of their results has arrived, and which episode is next.
// Results may arrive in any order, in pieces, twice or not at all; episodes leave strictly by index,
// each exactly once. No other class does any of this. Not thread-safe.
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

  /// The memory of so many orders in flight with their episodes, bytes.
  static int64_t BytesFor(const World& world, int64_t orders);

  /// Adds an order. The first one may have any index; CHECKs that each further index is the next one.
  void Write(const Order& order);

  enum class Arrival {
    kAccepted,      ///< new transitions of an order in flight
    kCompleted,     ///< the order's last missing transitions
    kDuplicate,     ///< nothing new, or an order that is done
    kUnknownOrder,  ///< an order that was never written
    kInconsistent,  ///< does not follow from its actions in this world; all parts of the result are dropped
  };

  /// Keeps a part of a result that FromWire accepted. When an order's last transition has arrived, the
  /// ledger flies the episode again from its actions. If every part agrees with this flight, TakeNext returns
  /// the flight; otherwise all parts are dropped.
  Arrival Add(const OrderResult& part);

  /// Removes the order with the lowest index and returns it with its episode; nullopt if that is not
  /// complete.
  std::optional<CommittedEpisode> TakeNext();

  /// Orders with an index below this one are done: TakeNext has returned them.
  int64_t committed() const { return committed_; }
  /// The number of orders in flight; their indices begin at committed().
  int64_t in_flight() const { return static_cast<int64_t>(entries_.size()); }
  /// The order with this index, which must be in flight.
  const Order& order(int64_t index) const { return entry(index).order; }
  bool IsComplete(int64_t index) const { return entry(index).episode.has_value(); }

 private:
  /// An order in flight, and what of its result has arrived.
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
