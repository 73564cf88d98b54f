#include "nn/adam.h"

#include <cmath>

#include "core/error.h"

namespace fresco {

Adam::Adam(int64_t parameter_count, AdamOptions options) : options_(options) {
  state_.first_moment = Vector::Zero(parameter_count);
  state_.second_moment = Vector::Zero(parameter_count);
}

void Adam::Step(std::span<const float> gradient, double learning_rate, std::span<float> parameters) {
  FRESCO_CHECK(static_cast<int64_t>(gradient.size()) == state_.first_moment.size());
  FRESCO_CHECK(gradient.size() == parameters.size());
  ++state_.steps;
  state_.beta1_power *= options_.beta1;
  state_.beta2_power *= options_.beta2;
  const auto beta1 = static_cast<float>(options_.beta1);
  const auto beta2 = static_cast<float>(options_.beta2);
  // The bias corrections are part of step size and epsilon here. The step is the same as with m_hat and
  // v_hat.
  const double root = std::sqrt(1 - state_.beta2_power);
  const auto step_size = static_cast<float>(learning_rate * root / (1 - state_.beta1_power));
  const auto epsilon = static_cast<float>(options_.epsilon * root);
  // A plain loop instead of Eigen, whose vectorised square root is an approximation. Here every operation is
  // correctly rounded, so the bits of an entry depend neither on its position nor on how the compiler
  // vectorises.
  const float* __restrict g = gradient.data();
  float* __restrict p = parameters.data();
  float* __restrict m = state_.first_moment.data();
  float* __restrict v = state_.second_moment.data();
  const size_t count = parameters.size();
  for (size_t i = 0; i < count; ++i) {
    m[i] = beta1 * m[i] + (1 - beta1) * g[i];
    v[i] = beta2 * v[i] + (1 - beta2) * (g[i] * g[i]);
    p[i] -= step_size * m[i] / (std::sqrt(v[i]) + epsilon);
  }
}

void Adam::Restore(State state) {
  FRESCO_CHECK(state.first_moment.size() == state_.first_moment.size());
  FRESCO_CHECK(state.second_moment.size() == state_.second_moment.size());
  state_ = std::move(state);
}

}  // namespace fresco
