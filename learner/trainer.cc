#include "learner/trainer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/check.h"
#include "learner/schedules.h"

namespace fresco {
namespace {

DqnOptions OptionsOf(const proto::Agent& agent) {
  return {agent.double_dqn(),
          static_cast<float>(agent.discount()),
          agent.batch_size(),
          {agent.adam().beta1(), agent.adam().beta2(), agent.adam().epsilon()}};
}

void Average(double value, double& average) {
  constexpr double kShare = 0.01;
  average += kShare * (value - average);
}

}  // namespace

Trainer::Trainer(const Experiment& experiment, const World& world, TrainerOutput output)
    : experiment_(experiment),
      world_(&world),
      output_(std::move(output)),
      expected_updates_(ExpectedUpdates(experiment.schedule(), world.maximum_transitions())),
      network_input_(world, experiment.network_input_options()),
      replay_(network_input_.size(), world.actions(), experiment.agent().replay_capacity()),
      batch_(network_input_.size(), world.actions(), experiment.agent().batch_size()),
      dqn_(experiment.network_shape(),
           InitialParameters(experiment.network_shape(), experiment.schedule().seed()),
           OptionsOf(experiment.agent())),
      observation_(static_cast<size_t>(network_input_.size())),
      next_observation_(static_cast<size_t>(network_input_.size())),
      least_values_(static_cast<size_t>(world.maximum_transitions())) {}

void Trainer::Begin() {
  newest_ = {std::make_shared<const Vector>(dqn_.current()), 0};
  output_.version(NetworkKind::kCurrent, 0, newest_.parameters);
  output_.version(NetworkKind::kTarget, 0, newest_.parameters);
  for (int i = 0; i < experiment_.schedule().window(); ++i) {
    WriteNextOrder();
  }
}

void Trainer::Commit(const Order& order, const Episode& episode) {
  FRESCO_CHECK(order.index == progress_.committed_orders && episode.order_index == order.index);
  if (order.kind == OrderKind::kEvaluate) {
    CommitEvaluation(order, episode);
  } else {
    Average(static_cast<double>(progress_.updates - updates_at_writing_.at(order.index)),
            progress_.staleness_updates);
    CommitTraining(episode);
  }
  updates_at_writing_.erase(order.index);
  ++progress_.committed_orders;
  WriteNextOrder();
  finished_ = final_evaluation_written_ && progress_.committed_orders == next_index_;
}

/// What the episode earned from each transition on: the world is deterministic, so that much is within
/// reach (a lower bound of Q*, as in He et al., "Learning to play in a day", 2017).
void Trainer::TakeLeastValues(const Episode& episode) {
  if (!experiment_.agent().flown_return_bound()) {
    std::fill(least_values_.begin(), least_values_.end(), -std::numeric_limits<float>::infinity());
    return;
  }
  double earned = 0;
  for (int transition = episode.transitions() - 1; transition >= 0; --transition) {
    const auto i = static_cast<size_t>(transition);
    earned = static_cast<double>(episode.rewards[i]) + experiment_.agent().discount() * earned;
    least_values_[i] = static_cast<float>(earned);
  }
}

void Trainer::CommitTraining(const Episode& episode) {
  TakeLeastValues(episode);
  for (int transition = 0; transition < episode.transitions(); ++transition) {
    Insert(episode, transition);
    ++progress_.transitions;
    progress_.replay_size = replay_.size();
    if (progress_.transitions >= experiment_.schedule().minimum_replay_size() &&
        progress_.transitions % experiment_.schedule().inserts_per_update() == 0) {
      UpdateOnce();
    }
  }
  ++progress_.episodes;
}

void Trainer::Insert(const Episode& episode, int transition) {
  const auto i = static_cast<size_t>(transition);
  network_input_.Write(episode.states[i], observation_);
  network_input_.Write(episode.states[i + 1], next_observation_);
  const auto mask_size = static_cast<size_t>(MaskSize(*world_));
  const bool last = transition + 1 == episode.transitions();
  replay_.Insert({observation_, next_observation_, episode.actions[i], episode.rewards[i], last,
                  std::span(episode.next_masks).subspan(i * mask_size, mask_size), least_values_[i]});
}

void Trainer::UpdateOnce() {
  const auto update = static_cast<uint64_t>(progress_.updates);
  RandomStream stream(experiment_.schedule().seed(), RandomPurpose::kReplaySampling,
                      static_cast<uint32_t>(update), static_cast<uint32_t>(update >> 32));
  replay_.Sample(stream, batch_);
  progress_.learning_rate =
      LearningRateOf(experiment_.agent(), progress_.updates, progress_.episodes, expected_updates_);
  Average(dqn_.Update(batch_, progress_.learning_rate), progress_.loss);
  ++progress_.updates;
  if (progress_.updates % experiment_.agent().target_update_period() == 0) {
    CopyToTarget();
  }
  if (progress_.updates % experiment_.schedule().updates_per_version() == 0) {
    MakeVersion();
  }
  if (output_.updated) {
    output_.updated();
  }
}

void Trainer::CopyToTarget() {
  dqn_.CopyToTarget();
  ++progress_.target_version;
  output_.version(NetworkKind::kTarget, progress_.target_version,
                  std::make_shared<const Vector>(dqn_.target()));
}

void Trainer::MakeVersion() {
  ++progress_.current_version;
  newest_ = {std::make_shared<const Vector>(dqn_.current()), progress_.updates};
  output_.version(NetworkKind::kCurrent, progress_.current_version, newest_.parameters);
  evaluation_due_ |= progress_.current_version % experiment_.schedule().versions_per_evaluation() == 0;
}

void Trainer::WriteNextOrder() {
  if (progress_.episodes == experiment_.schedule().episodes() && !final_evaluation_written_) {
    FinishTraining();
  } else if (evaluation_due_) {
    WriteOrder(OrderKind::kEvaluate);
  } else if (training_orders_ < experiment_.schedule().episodes()) {
    WriteOrder(OrderKind::kTrain);
  }
}

void Trainer::FinishTraining() {
  if (newest_.updates != progress_.updates) {
    MakeVersion();  // the final version, however few updates it has
  }
  WriteOrder(OrderKind::kEvaluate);
  final_evaluation_written_ = true;
}

void Trainer::WriteOrder(OrderKind kind) {
  Order order;
  order.index = next_index_++;
  order.kind = kind;
  order.seed = experiment_.schedule().seed();
  order.current_version = progress_.current_version;
  order.target_version = progress_.target_version;
  if (kind == OrderKind::kTrain) {
    order.epsilon = EpsilonOf(experiment_.schedule(), training_orders_++, progress_.transitions);
    progress_.epsilon = order.epsilon;
  } else {
    evaluating_[order.index] = newest_;
    evaluation_due_ = false;
  }
  updates_at_writing_[order.index] = progress_.updates;
  output_.order(order);
}

void Trainer::CommitEvaluation(const Order& order, const Episode& episode) {
  const auto found = evaluating_.find(order.index);
  FRESCO_CHECK(found != evaluating_.end());
  const Version version = found->second;
  evaluating_.erase(found);
  AoiAccumulator accumulator(*world_);
  for (const State& state : episode.states) {
    accumulator.Add(state.aoi);
  }
  const Evaluation evaluation{order.current_version, version.updates, progress_.episodes,
                              episode.outcome == Outcome::kArrived, accumulator.Finish()};
  const auto better = [](const Evaluation& a, const Evaluation& b) {
    return a.arrived != b.arrived ? a.arrived : a.arrived && a.figures.average_aoi < b.figures.average_aoi;
  };
  if (!best_ || better(evaluation, best_->evaluation) || !best_->evaluation.arrived) {
    best_ = {evaluation, version.parameters};
  }
  last_evaluation_ = evaluation;
  output_.evaluation(evaluation);
}

}  // namespace fresco
