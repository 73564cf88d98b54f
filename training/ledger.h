// The ledger: which orders are out, what of their results has arrived, and which episode comes next.
// Results may arrive in any order, in pieces, twice or not at all; episodes leave strictly by index,
// each exactly once. This is the only place that does any of these jobs. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "msgs/episode.h"
#include "msgs/order.h"

namespace fresco {

/// An order with its whole result.
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
    kInconsistent,  ///< does not follow from its actions in this world; everything of it is dropped
  };

  /// Takes a run of transitions that passed ToEpisodeRun.
  Arrival Add(const Episode& run);

  /// The episode of the lowest index, where it is whole; it is done then.
  std::optional<CommittedEpisode> TakeNext();

  /// Indices below are done.
  int64_t committed() const { return committed_; }
  /// Orders out, by index from committed() on.
  int64_t in_flight() const { return static_cast<int64_t>(entries_.size()); }
  const Order& order(int64_t index) const { return entry(index).order; }
  bool IsComplete(int64_t index) const { return entry(index).complete; }

 private:
  struct Entry {
    Order order;
    Episode episode;                // sized for the longest episode while it is assembled
    std::vector<uint8_t> received;  // by transition
    int received_count = 0;
    int length = 0;  // transitions; 0 while the run that ends the episode has not arrived
    bool complete = false;
  };

  const Entry& entry(int64_t index) const { return entries_[static_cast<size_t>(index - committed_)]; }
  void Prepare(Entry& entry) const;
  bool Merge(const Episode& run, Entry& entry) const;
  void Trim(Entry& entry) const;

  const World* world_;
  MaskOptions mask_options_;
  bool begun_ = false;
  int64_t committed_ = 0;
  std::deque<Entry> entries_;
};

}  // namespace fresco
