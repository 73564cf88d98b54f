// Adam (Kingma and Ba, 2015, Algorithm 1), single precision, fixed order of operations.
#pragma once

#include <cstdint>
#include <span>

#include "nn/mlp.h"

namespace fresco {

struct AdamOptions {
  double beta1 = 0.9;
  double beta2 = 0.999;
  double epsilon = 1e-8;
};

/// The moments of one parameter vector. Not thread-safe.
class Adam {
 public:
  Adam(int64_t parameter_count, AdamOptions options);

  /// What the moments take of memory.
  static int64_t BytesFor(int64_t parameter_count) {
    return 2 * parameter_count * static_cast<int64_t>(sizeof(Vector::Scalar));
  }

  /// One step: parameters -= learning_rate * m_hat / (sqrt(v_hat) + epsilon).
  void Step(std::span<const float> gradient, double learning_rate, std::span<float> parameters);

  /// Everything that a checkpoint needs to go on bit for bit.
  struct State {
    int64_t steps = 0;
    double beta1_power = 1.0;  ///< beta1^steps as accumulated
    double beta2_power = 1.0;
    Vector first_moment;
    Vector second_moment;
  };
  const State& state() const { return state_; }
  void Restore(State state);

 private:
  AdamOptions options_;
  State state_;
};

}  // namespace fresco
