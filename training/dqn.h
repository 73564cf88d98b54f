// The deep Q-network (DQN) of Algorithm 1: a current and a target network, and one gradient step for each
// mini-batch. Equal inputs give equal bits, whatever the number of threads. Does not allocate after
// construction. The trainer owns it. Only one thread may call it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/thread_team.h"
#include "nn/adam.h"
#include "nn/network.h"
#include "training/replay_memory.h"

namespace fresco {

/// Returns the allowed action with the largest of a column's values, among the actions from `first` to before
/// `end`; the lowest one if several have it; none if none is allowed. `mask` has 1 or 0 for each action.
std::optional<int> BestAllowedAction(const Matrix& values, int column, std::span<const uint8_t> mask,
                                     int first, int end);

/// The same among all actions. CHECKs that one is allowed.
int GreedyAction(const Matrix& values, int column, std::span<const uint8_t> mask);

struct DqnOptions {
  bool double_dqn = false;  ///< the current network chooses the action in s', the target network values it
  int batch_size = 200;     ///< transitions in a mini-batch, >= 1
  AdamOptions adam;
};

class Dqn {
 public:
  /// Both networks begin as `initial`, which has network->parameter_count() entries. `threads` (>= 1) share
  /// each update; their number changes no bit.
  Dqn(std::shared_ptr<const Network> network, const Vector& initial, DqnOptions options, int threads = 1);

  /// The memory of an object after its first update, bytes: for the networks, their gradient and Adam's
  /// moments, and for a batch.
  static int64_t ParameterBytes(const Network& network);
  static int64_t BatchBytes(const Network& network, int batch_size, int threads);

  /// Makes one step of Adam on the loss L = mean (y - Q(s, a))^2 (eq. Loss-Func) of a batch of exactly
  /// options.batch_size transitions. The target y is r plus the transition's discount times the target
  /// network's largest value over the actions allowed in s'. If y is below the transition's least value, that
  /// value replaces it. Returns L before the step.
  double Update(const MiniBatch& batch, double learning_rate);

  /// Copies the current network's parameters to the target network: theta^- = theta.
  void CopyToTarget() { target_ = current_; }

  const Vector& current() const { return current_; }
  const Vector& target() const { return target_; }
  const Adam::State& adam() const { return adam_.state(); }

  /// Replaces both networks and the state of the optimiser, for example by those of a checkpoint. CHECKs
  /// their sizes.
  void Restore(const Vector& current, const Vector& target, const Adam::State& adam);

 private:
  void ComputeColumns(const MiniBatch& batch, ColumnRange columns, NetworkWorkspace& next_workspace);
  void ComputeTargets(const MiniBatch& batch, ColumnRange columns, NetworkWorkspace& next_workspace);
  void TransposeAll();

  std::shared_ptr<const Network> network_;
  DqnOptions options_;
  Vector current_;
  Vector target_;
  Adam adam_;
  std::unique_ptr<NetworkWorkspace> workspace_;
  std::vector<float> targets_;           // y, by column
  std::vector<float> errors_;            // Q(s, a) - y, by column
  std::vector<float> output_gradients_;  // d L / d Q(s, a), by column
  std::vector<int16_t> choices_;         // actions chosen in s', by column
  ThreadTeam team_;
  /// What one thread works with.
  struct Scratch {
    std::unique_ptr<NetworkWorkspace> next;  // for s', of the columns of a job
    Vector gradient;                         // of a part of the parameters
  };
  std::vector<Scratch> scratches_;  // by thread
};

}  // namespace fresco
