#include "nn/adam.h"

#include <cmath>

#include "core/error.h"
#include "nn/arithmetic.h"

namespace fresco {

Adam::Adam(int64_t parameter_count, AdamOptions options) : options_(options) {
  state_.first_moment = Vector::Zero(parameter_count);
  state_.second_moment = Vector::Zero(parameter_count);
}

AdamStep Adam::Begin(double learning_rate) {
  ++state_.steps;
  state_.beta1_power *= options_.beta1;
  state_.beta2_power *= options_.beta2;
  // The bias corrections are part of step size and epsilon here. The step is the same as with m_hat and
  // v_hat.
  const double root = std::sqrt(1 - state_.beta2_power);
  return {static_cast<float>(options_.beta1), static_cast<float>(options_.beta2),
          static_cast<float>(learning_rate * root / (1 - state_.beta1_power)),
          static_cast<float>(options_.epsilon * root)};
}

void Adam::Step(const AdamStep& step, int64_t first, std::span<const float> gradient,
                std::span<float> parameters) {
  const auto count = static_cast<int64_t>(parameters.size());
  FRESCO_CHECK(gradient.size() == parameters.size());
  FRESCO_CHECK(first >= 0 && first + count <= state_.first_moment.size());
  CurrentArithmetic().step(step, count, gradient.data(), state_.first_moment.data() + first,
                           state_.second_moment.data() + first, parameters.data());
}

void Adam::Restore(State state) {
  FRESCO_CHECK(state.first_moment.size() == state_.first_moment.size());
  FRESCO_CHECK(state.second_moment.size() == state_.second_moment.size());
  state_ = std::move(state);
}

}  // namespace fresco
