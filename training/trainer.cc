#include "training/trainer.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/thread_team.h"
#include "training/schedules.h"

namespace fresco {
namespace {

DqnOptions OptionsOf(const proto::Agent& agent) {
  return {agent.double_dqn(),
          agent.batch_size(),
          {agent.adam().beta1(), agent.adam().beta2(), agent.adam().epsilon()}};
}

void Average(double value, double& average) {
  constexpr double kShare = 0.01;
  average += kShare * (value - average);
}

}  // namespace

int LearnerThreads(const proto::Run& run) {
  return run.learner_threads() > 0 ? run.learner_threads() : ProcessorCount() - ProcessorCount() / 4;
}

Trainer::Trainer(const Experiment& experiment, TrainerOutput output, int threads)
    : experiment_(experiment),
      output_(std::move(output)),
      expected_updates_(ExpectedUpdates(experiment.schedule(), experiment.world().longest_episode())),
      replay_(experiment.world().observation_size(), experiment.world().actions(),
              experiment.agent().replay_capacity()),
      history_(experiment.agent().replay_capacity()),
      batch_(experiment.world().observation_size(), experiment.world().actions(),
             experiment.agent().batch_size()),
      dqn_(experiment.network(), experiment.FirstParameters(), OptionsOf(experiment.agent()), threads),
      observations_(static_cast<size_t>(experiment.agent().n_step() + 1),
                    std::vector<float>(static_cast<size_t>(experiment.world().observation_size()))),
      least_values_(static_cast<size_t>(experiment.world().longest_episode())) {}

void Trainer::Begin() {
  Offer({NetworkKind::kCurrent, 0}, dqn_.current());
  Offer({NetworkKind::kTarget, 0}, dqn_.target());
  for (int i = 0; i < experiment_.schedule().window(); ++i) {
    WriteTrainingOrder();
  }
}

void Trainer::Commit(const Order& order, Episode episode) {
  FRESCO_CHECK(!orders_.empty() && order == orders_.front().order);
  const int64_t updates_at_writing = orders_.front().updates_at_writing;
  orders_.pop_front();
  ++progress_.committed_orders;
  if (order.kind == OrderKind::kEvaluate) {
    CommitEvaluation(order, episode);
  } else {
    Average(static_cast<double>(progress_.updates - updates_at_writing), progress_.staleness_updates);
    CommitTraining(std::move(episode));
  }
  ForgetVersions();
}

/// Computes the return that the episode earned from each transition on. In a world without chance this is a
/// lower bound of Q* (as in He et al., "Learning to play in a day", 2017), unless the episode was cut off.
void Trainer::ComputeLeastValues(const Episode& episode) {
  if (!experiment_.agent().flown_return_bound() || episode.ending == Ending::kTruncated) {
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

/// Every committed training episode is followed by one new training order. Evaluations are written in
/// addition, so they have no influence on the training orders.
void Trainer::CommitTraining(Episode episode) {
  const int64_t evaluations_due = EvaluationsDue();
  ComputeLeastValues(episode);
  BeginInserting(episode, 0);
  for (int transition = 0; transition < episode.transitions(); ++transition) {
    Insert(episode, transition);
    ++progress_.transitions;
    progress_.replay_size = replay_.size();
    if (progress_.transitions >= experiment_.schedule().minimum_replay_size() &&
        progress_.transitions % experiment_.schedule().inserts_per_update() == 0) {
      UpdateOnce();
    }
  }
  episode.ShrinkToFit();
  history_.Add(std::make_shared<const Episode>(std::move(episode)));
  ++progress_.episodes;
  if (AllEpisodesCommitted()) {
    WriteFinalEvaluation();
  } else {
    if (EvaluationsDue() > evaluations_due) {
      WriteEvaluation();
    }
    WriteTrainingOrder();
  }
}

/// How many evaluations the current network's versions have called for so far.
int64_t Trainer::EvaluationsDue() const {
  return progress_.current_version / experiment_.schedule().versions_per_evaluation();
}

/// Insert follows, with this transition of the episode and then with those behind it, one after the other.
void Trainer::BeginInserting(const Episode& episode, int transition) {
  for (int state = transition; state < transition + experiment_.agent().n_step(); ++state) {
    Observe(episode, state);
  }
}

/// Keeps what the network sees of a state, if the episode has that one.
void Trainer::Observe(const Episode& episode, int state) {
  if (state <= episode.transitions()) {
    experiment_.world().Observe(episode.state(static_cast<size_t>(state)), Observation(state));
  }
}

/// Inserts a transition together with the n_step - 1 ones behind it, or as many as there are.
void Trainer::Insert(const Episode& episode, int transition) {
  const auto i = static_cast<size_t>(transition);
  Observe(episode, transition + experiment_.agent().n_step());
  const int end = std::min(transition + experiment_.agent().n_step(), episode.transitions());
  double reward = 0;
  double discount = 1;
  for (size_t step = i; step < static_cast<size_t>(end); ++step) {
    reward += discount * static_cast<double>(episode.rewards[step]);
    discount *= experiment_.agent().discount();
  }
  const bool terminal = end == episode.transitions() && episode.ending == Ending::kTerminal;
  const auto mask_size = static_cast<size_t>(MaskSize(experiment_.world().actions()));
  replay_.Insert({Observation(transition), Observation(end), episode.actions[i], static_cast<float>(reward),
                  terminal ? 0.0f : static_cast<float>(discount),
                  std::span(episode.next_masks).subspan(static_cast<size_t>(end - 1) * mask_size, mask_size),
                  least_values_[i]});
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
  Offer({NetworkKind::kTarget, ++progress_.target_version}, dqn_.target());
}

void Trainer::MakeVersion() {
  Offer({NetworkKind::kCurrent, ++progress_.current_version}, dqn_.current());
}

void Trainer::Offer(NetworkVersion version, const Vector& parameters) {
  const auto copy = std::make_shared<const Vector>(parameters);
  versions_[version] = {version, progress_.updates, copy};
  output_.version(version, copy);
}

/// Drops the versions that no order in flight names. An order names the versions that are newest when it is
/// written, so the oldest order names the oldest versions.
void Trainer::ForgetVersions() {
  const bool none = orders_.empty();
  const int32_t current = none ? progress_.current_version : orders_.front().order.current_version;
  const int32_t target = none ? progress_.target_version : orders_.front().order.target_version;
  std::erase_if(versions_, [&](const auto& entry) {
    const auto& [kind, number] = entry.first;
    return number < (kind == NetworkKind::kCurrent ? current : target);
  });
}

void Trainer::WriteFinalEvaluation() {
  if (versions_.at({NetworkKind::kCurrent, progress_.current_version}).updates != progress_.updates) {
    MakeVersion();  // the final version, even if it has fewer updates than updates_per_version
  }
  WriteEvaluation();
}

void Trainer::WriteTrainingOrder() {
  const proto::Schedule& schedule = experiment_.schedule();
  if (training_orders_ < schedule.episodes()) {
    Order order;
    order.kind = OrderKind::kTrain;
    order.epsilon = EpsilonOf(schedule, training_orders_, progress_.transitions);
    if (const auto from = SearchedFrom(schedule, training_orders_, experiment_.world().longest_episode())) {
      order.search_width = schedule.search().width();
      order.search_from = *from;
    }
    order.seed = EpisodeSeed(schedule.seed(), training_orders_);
    progress_.epsilon = order.epsilon;
    ++training_orders_;
    WriteOrder(order);
  }
}

/// Writes the orders of one evaluation. Each has a seed of its own.
void Trainer::WriteEvaluation() {
  const proto::Schedule& schedule = experiment_.schedule();
  const int64_t fixed = progress_.delivering ? schedule.evaluation_episodes() : 0;
  const int64_t first = schedule.fixed_evaluation_episodes() ? fixed : evaluation_orders_;
  for (int i = 0; i < schedule.evaluation_episodes(); ++i) {
    Order order;
    order.kind = OrderKind::kEvaluate;
    order.seed = EvaluationSeed(schedule.seed(), first + i);
    ++evaluation_orders_;
    WriteOrder(order);
  }
}

/// Gives the order its index and the newest versions, and hands it out.
void Trainer::WriteOrder(Order order) {
  order.index = progress_.committed_orders + static_cast<int64_t>(orders_.size());
  order.current_version = progress_.current_version;
  order.target_version = progress_.target_version;
  orders_.push_back({order, progress_.updates});
  output_.order(order);
}

/// Adds one episode to its evaluation. The episodes of an evaluation are committed one after the other.
void Trainer::CommitEvaluation(const Order& order, const Episode& episode) {
  std::vector<double> figures(experiment_.world().description().figures.size());
  experiment_.world().Judge(episode, figures);
  PartialEvaluation& partial = partial_evaluation_;
  partial.figures.resize(figures.size());
  std::transform(figures.begin(), figures.end(), partial.figures.begin(), partial.figures.begin(),
                 std::plus<>());
  partial.scores.push_back(figures.front());
  partial.successes += experiment_.world().Succeeded(episode) ? 1 : 0;
  if (++partial.episodes == experiment_.schedule().evaluation_episodes()) {
    CompleteEvaluation(order);
  }
}

void Trainer::CompleteEvaluation(const Order& order) {
  const VersionState& version = versions_.at({NetworkKind::kCurrent, order.current_version});
  PartialEvaluation partial = std::exchange(partial_evaluation_, {});
  for (double& figure : partial.figures) {
    figure /= partial.episodes;
  }
  const Evaluation evaluation{
      order.current_version, version.updates,
      progress_.episodes,    static_cast<double>(partial.successes) / partial.episodes,
      partial.figures,       partial.scores};
  if (progress_.delivering) {
    delivered_ = evaluation;
    return;
  }
  if (!best_ || best_->evaluation.success == 0 || IsBetter(evaluation, best_->evaluation)) {
    best_ = {evaluation, version.parameters};
  }
  last_evaluation_ = evaluation;
  output_.evaluation(evaluation);
  if (AllEpisodesCommitted() && orders_.empty() && experiment_.world().description().random) {
    DeliverBest();
  }
}

bool Trainer::IsBetter(const Evaluation& a, const Evaluation& b) const {
  const bool less_is_better = experiment_.world().description().less_is_better;
  return a.success != b.success ? a.success > b.success
                                : (less_is_better ? a.score() < b.score() : a.score() > b.score());
}

/// Where chance decides, the best evaluation was lucky, too. So the best version becomes the newest one and
/// is judged once more.
void Trainer::DeliverBest() {
  progress_.delivering = true;
  const NetworkVersion version{NetworkKind::kCurrent, ++progress_.current_version};
  versions_[version] = {version, best_->evaluation.updates, best_->parameters};
  output_.version(version, best_->parameters);
  WriteEvaluation();
}

}  // namespace fresco
