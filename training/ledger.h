// The ledger knows which orders are in flight, what of their results has arrived, and which episode is next.
// Results may arrive in any order, in pieces, twice or not at all; episodes leave strictly by index,
// each exactly once. No other class does any of this. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/order.h"
#include "training/episode_assembly.h"
#include "worlds/episode.h"
#include "worlds/world.h"

namespace fresco {

/// An order and the episode that was flown for it, whose vectors have no spare room.
struct CommittedEpisode {
  Order order;
  Episode episode;
};

class Ledger {
 public:
  /// `world` must outlive the ledger.
  explicit Ledger(const World& world) : world_(&world) {}

  /// The memory of so many orders in flight with their episodes, bytes.
  static int64_t BytesFor(const World& world, int64_t orders);

  /// Adds an order. The first one may have any index; CHECKs that each further index is the next one.
  void Write(const Order& order);

  enum class Arrival {
    kAccepted,      ///< new transitions of an order in flight
    kCompleted,     ///< the order's last missing transitions
    kDuplicate,     ///< nothing new, or an order that is done
    kUnknownOrder,  ///< an order that was never written
    kInconsistent,  ///< contradicts another part, the order or the world; all that has arrived is dropped
  };

  /// Keeps a part of a result that FromWire accepted. When an order's last part has arrived, the episode is
  /// complete. If the world is repeatable, the ledger then flies it again from its actions, and drops it if
  /// that gives other bits.
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
    std::unique_ptr<EpisodeAssembly> parts = {};  // from the first one to the last
    std::optional<Episode> episode = {};          // once it is complete
  };

  const Entry& entry(int64_t index) const { return entries_[static_cast<size_t>(index - committed_)]; }
  std::unique_ptr<EpisodeAssembly> FreeAssembly();
  bool Follows(const Order& order, const Episode& episode);

  const World* world_;
  std::optional<EpisodeRecorder> check_;  // flies episodes again; made for the first one
  std::vector<std::unique_ptr<EpisodeAssembly>> free_assemblies_;
  bool begun_ = false;
  int64_t committed_ = 0;
  std::deque<Entry> entries_;
};

}  // namespace fresco
