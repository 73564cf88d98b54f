// A beam search for a good episode: because the world is known, the values of a network can guide a search
// through many episodes side by side. Of the partial episodes of each length it keeps the `width` best ones,
// those with the largest sum of what they have earned and of what the network expects from their last state
// on; of several that are in the same state, the one that has earned most. The result is a pure function of
// world, seed, parameters and width. Only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "msgs/experiment.h"
#include "nn/network.h"
#include "worlds/world.h"

namespace fresco {

class BeamSearch {
 public:
  /// CHECKs that the world's environments can be copied (WorldDescription::copies) and that `width` is at
  /// least 1.
  BeamSearch(const Experiment& experiment, int width);

  /// The memory of an object, bytes.
  static int64_t BytesFor(const Experiment& experiment, int width);

  /// Begins with the episode of a seed.
  void Begin(uint64_t seed, std::shared_ptr<const Vector> parameters);

  /// Makes the partial episodes longer by one step. Returns false once all of them have ended.
  bool Step();

  /// The actions of the best episode that has ended, once Step has returned false.
  std::vector<int16_t> BestActions() const;

 private:
  /// Where a partial episode comes from: a node of the step before, and the action taken there.
  struct Origin {
    int32_t parent = 0;
    int16_t action = 0;
  };
  /// A partial episode, by its last state.
  struct Node {
    explicit Node(const World& world);

    std::unique_ptr<Environment> environment;
    std::vector<float> state;
    std::vector<uint8_t> mask;
    std::vector<float> action_values;  // what the network expects of each action
    Origin origin;
    double earned = 0;  // the sum of its rewards
    double value = 0;   // the same, and what the network expects from here on
  };
  /// An action that a node may take.
  struct Choice {
    double value = 0;
    Origin origin;
  };

  void Choose();
  void Try();
  void DropRepeatedStates();
  void Evaluate();
  void Keep();

  Experiment experiment_;
  size_t width_;
  std::shared_ptr<const Vector> parameters_;
  std::unique_ptr<NetworkWorkspace> workspace_;
  std::vector<Node> nodes_;       // the partial episodes, best first; only the first `kept_` are in use
  std::vector<Node> candidates_;  // longer by a step; only those that `tried_` names are in use
  size_t kept_ = 0;
  std::vector<size_t> tried_;
  std::vector<Choice> choices_;
  std::vector<std::vector<Origin>> steps_;  // by step: the origins of the nodes that were kept
  double best_return_ = 0;
  size_t best_step_ = 0;  // the last step of the best episode that has ended; none if it is 0
  Origin best_origin_;
};

/// The episode of a seed that a search of this width finds, or the greedy one if that earns more: what
/// `fresco evaluate --search` flies.
Episode FlySearching(const Experiment& experiment, uint64_t seed, std::shared_ptr<const Vector> parameters,
                     int width);

}  // namespace fresco
