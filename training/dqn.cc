#include "training/dqn.h"

#include <algorithm>

#include "core/error.h"

namespace fresco {
std::optional<int> BestAllowedAction(const Matrix& values, int column, std::span<const uint8_t> mask,
                                     int first, int end) {
  std::optional<int> best;
  for (int action = first; action < end; ++action) {
    if (mask[static_cast<size_t>(action)] != 0 && (!best || values(action, column) > values(*best, column))) {
      best = action;
    }
  }
  return best;
}

int GreedyAction(const Matrix& values, int column, std::span<const uint8_t> mask) {
  const std::optional<int> best = BestAllowedAction(values, column, mask, 0, static_cast<int>(mask.size()));
  FRESCO_CHECK(best);
  return *best;
}

Dqn::Dqn(const MlpShape& shape, const Vector& initial, DqnOptions options)
    : mlp_(shape),
      options_(options),
      current_(initial),
      target_(initial),
      adam_(shape.parameter_count(), options.adam),
      workspace_(shape, options.batch_size),
      next_workspace_(shape, options.batch_size),
      targets_(options.batch_size),
      output_gradient_(shape.outputs(), options.batch_size),
      gradient_(shape.parameter_count()),
      choices_(static_cast<size_t>(options.batch_size)) {}

int64_t Dqn::ParameterBytes(const MlpShape& shape) {
  constexpr int64_t kVectors = 3;  // current, target, gradient
  return kVectors * shape.parameter_count() * static_cast<int64_t>(sizeof(Vector::Scalar)) +
         Adam::BytesFor(shape.parameter_count());
}

int64_t Dqn::BatchBytes(const MlpShape& shape, int batch_size) {
  const auto of_column = static_cast<int64_t>(sizeof(Vector::Scalar)) * (1 + shape.outputs()) +
                         static_cast<int64_t>(sizeof(decltype(choices_)::value_type));
  return MlpWorkspace::BytesFor(shape, batch_size, true) + MlpWorkspace::BytesFor(shape, batch_size, false) +
         batch_size * of_column;
}

void Dqn::Restore(const Vector& current, const Vector& target, const Adam::State& adam) {
  FRESCO_CHECK(current.size() == current_.size() && target.size() == target_.size());
  current_ = current;
  target_ = target;
  adam_.Restore(adam);
}

double Dqn::Update(const MiniBatch& batch, double learning_rate) {
  FRESCO_CHECK(batch.size() == options_.batch_size);
  const int size = batch.size();
  ComputeTargets(batch);
  workspace_.input().leftCols(size) = batch.observations;
  mlp_.Forward(Values(current_), size, workspace_);
  output_gradient_.setZero();
  double loss = 0;
  for (int column = 0; column < size; ++column) {
    const int action = batch.actions[static_cast<size_t>(column)];
    const float error = workspace_.output()(action, column) - targets_(column);
    output_gradient_(action, column) = 2.0f * error / static_cast<float>(size);
    loss += static_cast<double>(error) * static_cast<double>(error);
  }
  mlp_.Backward(Values(current_), size, output_gradient_, workspace_,
                {gradient_.data(), static_cast<size_t>(gradient_.size())});
  adam_.Step(Values(gradient_), learning_rate, {current_.data(), static_cast<size_t>(current_.size())});
  return loss / size;
}

void Dqn::ComputeTargets(const MiniBatch& batch) {
  const int size = batch.size();
  next_workspace_.input().leftCols(size) = batch.next_observations;
  if (options_.double_dqn) {
    mlp_.Forward(Values(current_), size, next_workspace_);
    for (int column = 0; column < size; ++column) {
      choices_[static_cast<size_t>(column)] =
          GreedyAction(next_workspace_.output(), column, batch.next_mask(column));
    }
  }
  mlp_.Forward(Values(target_), size, next_workspace_);
  for (int column = 0; column < size; ++column) {
    const auto i = static_cast<size_t>(column);
    const int choice = options_.double_dqn
                           ? choices_[i]
                           : GreedyAction(next_workspace_.output(), column, batch.next_mask(column));
    const float next_value = next_workspace_.output()(choice, column);
    const float later = batch.terminal[i] != 0 ? 0.0f : options_.discount * next_value;
    targets_(column) = std::max(batch.rewards[i] + later, batch.least_values[i]);
  }
}

}  // namespace fresco
