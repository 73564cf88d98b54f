// Flies orders in many environments side by side: epsilon-greedily, and from the order's search_from on as a
// beam search found it. Environments whose orders name the same two versions share one forward pass. The
// episode of an order is a pure function of the order and its networks; neither the other flights nor its
// column in the batch change a bit. Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/random.h"
#include "msgs/experiment.h"
#include "msgs/order.h"
#include "nn/network.h"
#include "training/beam_search.h"
#include "training/dqn.h"
#include "worlds/episode.h"

namespace fresco {

/// Parameters of one network version, shared by whoever flies with it.
using SharedParameters = std::shared_ptr<const Vector>;

class Flyer {
 public:
  /// Up to `capacity` environments at a time.
  Flyer(const Experiment& experiment, int capacity);

  /// What it takes of memory beside the object itself and the networks, with so many flights at a time at
  /// most.
  static int64_t BytesFor(const Experiment& experiment, int capacity, int64_t flights);

  bool HasRoom() const { return flights_.size() < static_cast<size_t>(capacity_); }
  bool Idle() const { return flights_.empty(); }
  int open_flights() const { return static_cast<int>(flights_.size()); }
  bool IsFlying(int64_t order_index) const;
  std::vector<int64_t> OrderIndices() const;

  /// Begins the flight of an order with the parameters of its two versions. CHECKs that there is room, and
  /// that the order does not search or its search_width is schedule.search.width.
  void Start(const Order& order, SharedParameters current, SharedParameters target);

  /// Takes one step of every open order, except those that wait for their search; one of these searches a
  /// step further. Calls `finished` with the order and the result of each episode that ends; the result is
  /// valid during the call. Without searches, it allocates nothing once it has had as many flights at a time
  /// and episodes as long.
  void Step(const std::function<void(const Order&, const OrderResult&)>& finished);

 private:
  struct Flight {
    explicit Flight(const World& world) : recorder(world) {}

    Order order;
    SharedParameters current;
    SharedParameters target;
    EpisodeRecorder recorder;
    OrderResult result;         // td_errors grows with every transition; the rest is there at the end
    float chosen_value = 0;     // Q(s, a) of the last transition
    std::optional<int> place;   // that an excursion leads to
    std::vector<int16_t> plan;  // all actions of the episode, once the search has found them
    bool done = false;          // the episode has ended and its last error is known
  };

  static std::pair<int32_t, int32_t> Versions(const Flight& flight);
  std::unique_ptr<Flight> FreeFlight();
  static bool WaitsForSearch(const Flight& flight);
  void StepSearch();
  void StepGroup(std::span<Flight* const> group);
  void Finish(Flight& flight, const std::function<void(const Order&, const OrderResult&)>& finished);
  void FinishLastTransition(Flight& flight, int column);
  int ChooseAction(Flight& flight, int column) const;
  std::optional<int> Explore(Flight& flight, int column) const;
  void Act(Flight& flight, int action, float value);

  Experiment experiment_;
  bool double_dqn_;
  float discount_;
  double excursion_share_;
  int capacity_;
  std::unique_ptr<NetworkWorkspace> current_workspace_;
  std::unique_ptr<NetworkWorkspace> target_workspace_;
  std::vector<std::unique_ptr<Flight>> flights_;  // those of the same two versions are neighbours
  std::vector<std::unique_ptr<Flight>> free_flights_;
  std::vector<Flight*> stepping_;     // those of flights_ that do not wait for a search
  std::optional<BeamSearch> search_;  // if the schedule has searches
  Flight* searching_ = nullptr;       // whose plan search_ is at
};

/// One greedy episode with a network: what `fresco evaluate` flies.
Episode FlyGreedily(const Experiment& experiment, uint64_t seed, SharedParameters parameters);

}  // namespace fresco
