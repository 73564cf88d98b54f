// The optimiser Adam (Kingma and Ba, 2015, Algorithm 1) in single precision. Each operation is rounded by
// itself, so equal inputs give equal bits on every processor. Dqn owns one.
#pragma once

#include <cstdint>
#include <span>

#include "nn/arithmetic_kernels.h"
#include "nn/network.h"

namespace fresco {

struct AdamOptions {
  double beta1 = 0.9;     ///< decay of the first moment, 0 <= beta1 < 1
  double beta2 = 0.999;   ///< decay of the second moment, 0 <= beta2 < 1
  double epsilon = 1e-8;  ///< > 0
};

/// Holds the moments of one parameter vector.
class Adam {
 public:
  /// Begins with zero moments for `parameter_count` (>= 1) parameters.
  Adam(int64_t parameter_count, AdamOptions options);

  /// The memory of the moments, bytes.
  static int64_t BytesFor(int64_t parameter_count) {
    return 2 * parameter_count * static_cast<int64_t>(sizeof(Vector::Scalar));
  }

  /// Begins the next step: parameters -= learning_rate * m_hat / (sqrt(v_hat) + epsilon).
  AdamStep Begin(double learning_rate);

  /// Makes the step for `parameters`, which are those from number `first` on, with their gradient of the same
  /// size. CHECKs that. Threads may share a step if each has parameters of its own.
  void Step(const AdamStep& step, int64_t first, std::span<const float> gradient,
            std::span<float> parameters);

  /// Everything that the optimiser needs to continue with the same bits.
  struct State {
    int64_t steps = 0;
    double beta1_power = 1.0;  ///< beta1^steps, as multiplied step by step
    double beta2_power = 1.0;  ///< beta2^steps, as multiplied step by step
    Vector first_moment;       ///< [parameter_count]
    Vector second_moment;      ///< [parameter_count]
  };
  const State& state() const { return state_; }
  /// Replaces the state. CHECKs the sizes of the moments.
  void Restore(State state);

 private:
  AdamOptions options_;
  State state_;
};

}  // namespace fresco
