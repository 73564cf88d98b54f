#include "training/dqn.h"

#include <algorithm>

#include "core/error.h"

namespace fresco {
namespace {

// The arithmetic computes so many columns together.
constexpr int kColumnMultiple = 8;

/// How many jobs the columns of a batch are divided into. Two for each thread, if there is more than one: so
/// a thread that was interrupted does less.
int ColumnJobs(int batch_size, int threads) {
  const int multiples = (batch_size + kColumnMultiple - 1) / kColumnMultiple;
  return threads == 1 ? 1 : std::min(multiples, 2 * threads);
}

/// The columns of a job: all jobs have about as many.
ColumnRange ColumnsOfJob(int job, int jobs, int batch_size) {
  const int multiples = (batch_size + kColumnMultiple - 1) / kColumnMultiple;
  const auto begin_of = [&](int i) { return std::min(batch_size, i * multiples / jobs * kColumnMultiple); };
  return {begin_of(job), begin_of(job + 1)};
}

int MostColumnsOfJob(int batch_size, int threads) {
  const int jobs = ColumnJobs(batch_size, threads);
  int most = 0;
  for (int job = 0; job < jobs; ++job) {
    const ColumnRange columns = ColumnsOfJob(job, jobs, batch_size);
    most = std::max(most, columns.end - columns.first);
  }
  return most;
}

}  // namespace

// Without branches, since the largest value is hard to predict.
std::optional<int> BestAllowedAction(const Matrix& values, int column, std::span<const uint8_t> mask,
                                     int first, int end) {
  const float* value = values.col(column).data();
  int best = -1;
  float best_value = 0;
  for (int action = first; action < end; ++action) {
    const bool better =
        (mask[static_cast<size_t>(action)] != 0) & ((best < 0) | (value[action] > best_value));
    best = better ? action : best;
    best_value = better ? value[action] : best_value;
  }
  return best < 0 ? std::nullopt : std::optional(best);
}

int GreedyAction(const Matrix& values, int column, std::span<const uint8_t> mask) {
  const std::optional<int> best = BestAllowedAction(values, column, mask, 0, static_cast<int>(mask.size()));
  FRESCO_CHECK(best);
  return *best;
}

Dqn::Dqn(std::shared_ptr<const Network> network, const Vector& initial, DqnOptions options, int threads)
    : network_(std::move(network)),
      options_(options),
      current_(initial),
      target_(initial),
      adam_(network_->parameter_count(), options.adam),
      workspace_(network_->NewWorkspace(options.batch_size, NetworkWorkspace::Passes::kForwardAndBackward)),
      targets_(static_cast<size_t>(options.batch_size)),
      errors_(targets_.size()),
      output_gradients_(targets_.size()),
      choices_(targets_.size()),
      team_(threads) {
  for (int thread = 0; thread < threads; ++thread) {
    scratches_.push_back({network_->NewWorkspace(MostColumnsOfJob(options.batch_size, threads),
                                                 NetworkWorkspace::Passes::kForward),
                          Vector(network_->LargestPart())});
  }
  TransposeAll();
}

void Dqn::TransposeAll() {
  for (const ParameterPart& part : network_->parts()) {
    network_->Transpose(Values(current_), part, *workspace_);
  }
}

int64_t Dqn::ParameterBytes(const Network& network) {
  constexpr int64_t kVectors = 2;  // current, target
  return kVectors * network.parameter_count() * static_cast<int64_t>(sizeof(Vector::Scalar)) +
         Adam::BytesFor(network.parameter_count());
}

int64_t Dqn::BatchBytes(const Network& network, int batch_size, int threads) {
  const auto of_column = static_cast<int64_t>(
      sizeof(decltype(targets_)::value_type) + sizeof(decltype(errors_)::value_type) +
      sizeof(decltype(output_gradients_)::value_type) + sizeof(decltype(choices_)::value_type));
  return network.WorkspaceBytes(batch_size, NetworkWorkspace::Passes::kForwardAndBackward) +
         threads * (network.WorkspaceBytes(MostColumnsOfJob(batch_size, threads),
                                           NetworkWorkspace::Passes::kForward) +
                    network.LargestPart() * static_cast<int64_t>(sizeof(Vector::Scalar))) +
         batch_size * of_column;
}

void Dqn::Restore(const Vector& current, const Vector& target, const Adam::State& adam) {
  FRESCO_CHECK(current.size() == current_.size() && target.size() == target_.size());
  current_ = current;
  target_ = target;
  adam_.Restore(adam);
  TransposeAll();
}

double Dqn::Update(const MiniBatch& batch, double learning_rate) {
  FRESCO_CHECK(batch.size() == options_.batch_size);
  const int size = batch.size();
  const int jobs = ColumnJobs(size, team_.threads());
  team_.Run(jobs, [&](int job, int thread) {
    ComputeColumns(batch, ColumnsOfJob(job, jobs, size), *scratches_[static_cast<size_t>(thread)].next);
  });
  const OutputGradient output_gradient{batch.actions, output_gradients_};
  const AdamStep step = adam_.Begin(learning_rate);
  team_.Run(static_cast<int>(network_->parts().size()), [&](int job, int thread) {
    const ParameterPart& part = network_->parts()[static_cast<size_t>(job)];
    const auto count = static_cast<size_t>(part.size());
    const std::span gradient = Values(scratches_[static_cast<size_t>(thread)].gradient).first(count);
    network_->BackwardPart(output_gradient, size, part, *workspace_, gradient);
    adam_.Step(step, part.first, gradient, Values(current_).subspan(static_cast<size_t>(part.first), count));
    network_->Transpose(Values(current_), part, *workspace_);
  });
  double loss = 0;
  for (const float error : errors_) {
    loss += static_cast<double>(error) * static_cast<double>(error);
  }
  return loss / size;
}

/// What an update does with columns of the batch up to the gradients of the hidden units. Every column is
/// computed by itself.
void Dqn::ComputeColumns(const MiniBatch& batch, ColumnRange columns, NetworkWorkspace& next_workspace) {
  ComputeTargets(batch, columns, next_workspace);
  const int count = columns.end - columns.first;
  workspace_->input().middleCols(columns.first, count) = batch.observations.middleCols(columns.first, count);
  network_->ForwardUnits(Values(current_), batch.actions, columns, *workspace_);
  for (int column = columns.first; column < columns.end; ++column) {
    const auto i = static_cast<size_t>(column);
    errors_[i] = workspace_->output()(batch.actions[i], column) - targets_[i];
    output_gradients_[i] = 2.0f * errors_[i] / static_cast<float>(batch.size());
  }
  network_->BackwardColumns({batch.actions, output_gradients_}, columns, *workspace_);
}

void Dqn::ComputeTargets(const MiniBatch& batch, ColumnRange columns, NetworkWorkspace& next_workspace) {
  const ColumnRange next_columns{0, columns.end - columns.first};
  const auto choices =
      std::span(choices_).subspan(static_cast<size_t>(columns.first), static_cast<size_t>(next_columns.end));
  next_workspace.input().leftCols(next_columns.end) =
      batch.next_observations.middleCols(columns.first, next_columns.end);
  network_->Forward(Values(options_.double_dqn ? current_ : target_), next_columns, next_workspace);
  for (int column = 0; column < next_columns.end; ++column) {
    choices[static_cast<size_t>(column)] = static_cast<int16_t>(
        GreedyAction(next_workspace.output(), column, batch.next_mask(columns.first + column)));
  }
  if (options_.double_dqn) {
    network_->ForwardUnits(Values(target_), choices, next_columns, next_workspace);
  }
  for (int column = 0; column < next_columns.end; ++column) {
    const auto i = static_cast<size_t>(columns.first + column);
    const float next_value = next_workspace.output()(choices[static_cast<size_t>(column)], column);
    const float later = batch.discounts[i] * next_value;
    targets_[i] = std::max(batch.rewards[i] + later, batch.least_values[i]);
  }
}

}  // namespace fresco
