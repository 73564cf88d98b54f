// A beam search for a good episode: because the world is known, the values of a network can guide a search
// through many episodes side by side. Of the partial episodes of each length it keeps the `width` best ones,
// those with the largest sum of what they earned before their last action and of what the network expects of
// that action. It takes none if it has one already that is at least as good: in its state
// (WorldDescription::preferences) and in what it has earned; one that is better takes the place of the first
// that it is better than. The result is a pure function of world, seed,
// parameters and width. Only one thread at a time may use an object.
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

  /// The memory of an object, bytes. What a copy of an environment keeps on the heap is left out.
  static int64_t BytesFor(const Experiment& experiment, int width);

  int width() const { return static_cast<int>(width_); }

  /// Begins with the episode of a seed, behind the actions `first`, which its masks allow and which do not
  /// end it.
  void Begin(uint64_t seed, std::shared_ptr<const Vector> parameters, std::span<const int16_t> first = {});

  /// Makes the partial episodes longer by one step. Returns false once all of them have ended.
  bool Step();

  /// All actions of the best episode that has ended, once Step has returned false.
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
    Origin origin;
    double earned = 0;  // the sum of its rewards
  };
  /// An action that a node may take.
  struct Choice {
    double value = 0;
    Origin origin;
  };

  /// Orders states by the bits of those fields that have to be equal to compare the others.
  struct ByEqualFields {
    bool operator()(const std::vector<float>* a, const std::vector<float>* b) const;
    const BeamSearch* search;
  };

  void Evaluate();
  void Choose();
  bool Try(const Origin& origin, Node& node);
  bool IsAsGoodAs(const Node& node, const Node& other) const;

  Experiment experiment_;
  size_t width_;
  std::vector<size_t> equal_fields_;  // the fields of a state that have to be equal, and the others
  std::vector<size_t> ordered_fields_;
  std::vector<int16_t> first_;  // the actions before the search
  std::shared_ptr<const Vector> parameters_;
  std::unique_ptr<NetworkWorkspace> workspace_;
  std::vector<Node> nodes_;   // the partial episodes; only the first `count_` are in use
  std::vector<Node> longer_;  // room for those that are longer by a step
  size_t count_ = 0;
  std::vector<Choice> choices_;
  std::vector<std::vector<Origin>> steps_;  // by step: the origins of its nodes
  double best_return_ = 0;
  size_t best_step_ = 0;  // the last step of the best episode that has ended; none if it is 0
  Origin best_origin_;
};

/// The episode of a seed that a search of this width finds, or the greedy one if that earns more: what
/// `fresco evaluate --search` flies.
Episode FlySearching(const Experiment& experiment, uint64_t seed, std::shared_ptr<const Vector> parameters,
                     int width);

}  // namespace fresco
