// The DQN of Algorithm 1: current and target network, one gradient step a mini-batch. Pure
// arithmetic in a fixed order; no allocation after construction. Not thread-safe.
#pragma once

#include <cstdint>

#include "nn/adam.h"
#include "nn/mlp.h"
#include "training/replay_memory.h"

namespace fresco {

struct DqnOptions {
  bool double_dqn = false;  ///< the current network chooses in s', the target network values
  float discount = 1;       ///< gamma
  int batch_size = 200;
  AdamOptions adam;
};

class Dqn {
 public:
  /// Both networks begin as `initial`.
  Dqn(const MlpShape& shape, const Vector& initial, DqnOptions options);

  /// What it takes of memory beside the object itself, once it is warm: for the networks, their gradient and
  /// Adam's moments, and for a batch.
  static int64_t ParameterBytes(const MlpShape& shape);
  static int64_t BatchBytes(const MlpShape& shape, int batch_size);

  /// One step on L = mean (y - Q(s, a))^2 (eq. Loss-Func), y = r, plus discount * max over the
  /// actions allowed in s' of the target network where s' is not terminal; y is at least the
  /// transition's least value. Returns L before the step.
  double Update(const MiniBatch& batch, double learning_rate);

  /// theta^- = theta.
  void CopyToTarget() { target_ = current_; }

  const Vector& current() const { return current_; }
  const Vector& target() const { return target_; }
  const Adam::State& adam() const { return adam_.state(); }

  /// Goes on from networks and moments of another time. CHECKs their sizes.
  void Restore(const Vector& current, const Vector& target, const Adam::State& adam);

 private:
  void ComputeTargets(const MiniBatch& batch);

  Mlp mlp_;
  DqnOptions options_;
  Vector current_;
  Vector target_;
  Adam adam_;
  MlpWorkspace workspace_;
  MlpWorkspace next_workspace_;
  Vector targets_;          // y
  Matrix output_gradient_;  // [actions x batch]
  Vector gradient_;
  std::vector<int> choices_;  // of the current network in s', Double DQN only
};

}  // namespace fresco
