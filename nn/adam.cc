#include "nn/adam.h"

#include <cmath>

#include "core/check.h"

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
  // The bias corrections folded into step size and epsilon: the same step as with m_hat and v_hat.
  const double root = std::sqrt(1 - state_.beta2_power);
  const auto step_size = static_cast<float>(learning_rate * root / (1 - state_.beta1_power));
  const auto epsilon = static_cast<float>(options_.epsilon * root);
  const Eigen::Map<const Eigen::ArrayXf> g(gradient.data(), static_cast<int64_t>(gradient.size()));
  Eigen::Map<Eigen::ArrayXf> p(parameters.data(), static_cast<int64_t>(parameters.size()));
  auto m = state_.first_moment.array();
  auto v = state_.second_moment.array();
  m = beta1 * m + (1 - beta1) * g;
  v = beta2 * v + (1 - beta2) * g.square();
  p -= step_size * m / (v.sqrt() + epsilon);
}

void Adam::Restore(State state) {
  FRESCO_CHECK(state.first_moment.size() == state_.first_moment.size());
  FRESCO_CHECK(state.second_moment.size() == state_.second_moment.size());
  state_ = std::move(state);
}

}  // namespace fresco
