// Trainer's way into a TrainingState and back.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "training/trainer.h"

namespace fresco {
namespace {

void Expect(bool condition, const std::string& problem) {
  if (!condition) {
    throw Failure("the training can't continue from this state: " + problem);
  }
}

}  // namespace

TrainingState Trainer::Save() const {
  TrainingState state;
  state.progress = progress_;
  state.orders.assign(orders_.begin(), orders_.end());
  for (const auto& [key, version] : versions_) {
    state.versions.push_back(version);
  }
  state.current = dqn_.current();
  state.target = dqn_.target();
  state.adam = dqn_.adam();
  state.replay = history_.episodes();
  state.partial_evaluation = partial_evaluation_;
  state.last_evaluation = last_evaluation_;
  state.best = best_;
  state.delivered = delivered_;
  return state;
}

void Trainer::Resume(const TrainingState& state) {
  CheckState(state);
  progress_ = state.progress;
  training_orders_ = state.progress.episodes;
  evaluation_orders_ = state.progress.committed_orders - state.progress.episodes;
  partial_evaluation_ = state.partial_evaluation;
  delivered_ = state.delivered;
  last_evaluation_ = state.last_evaluation;
  best_ = state.best;
  dqn_.Restore(state.current, state.target, state.adam);
  RefillReplay(state);
  for (const VersionState& version : state.versions) {
    versions_[version.version] = version;
    output_.version(version.version, version.parameters);
  }
  for (const OrderInFlight& order : state.orders) {
    orders_.push_back(order);
    ++(order.order.kind == OrderKind::kTrain ? training_orders_ : evaluation_orders_);
    output_.order(order.order);
  }
}

void Trainer::CheckState(const TrainingState& state) const {
  const int64_t parameters = dqn_.current().size();
  const auto has = [&](NetworkVersion version) {
    return std::any_of(state.versions.begin(), state.versions.end(), [&](const VersionState& entry) {
      return entry.version == version && entry.parameters->size() == parameters;
    });
  };
  for (const Vector* vector :
       {&state.current, &state.target, &state.adam.first_moment, &state.adam.second_moment}) {
    Expect(vector->size() == parameters,
           fmt::format("expected {} parameters, found {}", parameters, vector->size()));
  }
  Expect(has({NetworkKind::kCurrent, state.progress.current_version}) &&
             has({NetworkKind::kTarget, state.progress.target_version}),
         "it lacks the newest version of a network");
  int64_t index = state.progress.committed_orders;
  for (const OrderInFlight& entry : state.orders) {
    const Order& order = entry.order;
    Expect(order.index == index, fmt::format("expected order {}, found {}", index, order.index));
    const std::array<NetworkVersion, 2> versions = VersionsOf(order);
    Expect(std::all_of(versions.begin(), versions.end(), has),
           fmt::format("it lacks a network version that order {} names", index));
    ++index;
  }
  CheckProgress(state);
  CheckOrders(state);
  CheckEvaluations(state);
}

/// What holds of every training of this experiment: nothing of it can run over, and no update is missing.
void Trainer::CheckProgress(const TrainingState& state) const {
  const TrainerProgress& progress = state.progress;
  const proto::Schedule& schedule = experiment_.schedule();
  Expect(0 <= progress.episodes && progress.episodes <= schedule.episodes() &&
             progress.episodes <= progress.committed_orders,
         fmt::format("{} episodes of {}, {} orders committed", progress.episodes, schedule.episodes(),
                     progress.committed_orders));
  Expect(progress.episodes <= progress.transitions &&
             progress.transitions <= progress.episodes * experiment_.world().longest_episode(),
         fmt::format("{} transitions of {} episodes", progress.transitions, progress.episodes));
  Expect(0 <= progress.updates && progress.updates <= progress.transitions / schedule.inserts_per_update() &&
             state.adam.steps == progress.updates,
         fmt::format("{} updates and {} steps of the optimiser after {} transitions", progress.updates,
                     state.adam.steps, progress.transitions));
  const int64_t whole = progress.updates / schedule.updates_per_version();
  // After the last episode there may be a version with fewer updates, and the best one again.
  const int64_t further = progress.episodes == schedule.episodes() ? 1 + (progress.delivering ? 1 : 0) : 0;
  Expect(whole <= progress.current_version && progress.current_version <= whole + further &&
             progress.target_version == progress.updates / experiment_.agent().target_update_period(),
         fmt::format("versions {} and {} after {} updates", progress.current_version, progress.target_version,
                     progress.updates));
}

/// The orders in flight: they name no older version than the one before, and are all that is not committed.
void Trainer::CheckOrders(const TrainingState& state) const {
  const TrainerProgress& progress = state.progress;
  int64_t training = 0;
  int32_t current = 0;
  int32_t target = 0;
  for (const auto& [order, updates_at_writing] : state.orders) {
    Expect(current <= order.current_version && order.current_version <= progress.current_version &&
               target <= order.target_version && order.target_version <= progress.target_version &&
               0 <= updates_at_writing && updates_at_writing <= progress.updates,
           fmt::format("order {} names versions {} and {} after {} updates", order.index,
                       order.current_version, order.target_version, updates_at_writing));
    Expect(SearchFits(order, experiment_.schedule(), experiment_.world().longest_episode()),
           fmt::format("order {} has a search of width {} from transition {} on", order.index,
                       order.search_width, order.search_from));
    current = order.current_version;
    target = order.target_version;
    training += order.kind == OrderKind::kTrain;
  }
  const proto::Schedule& schedule = experiment_.schedule();
  const int64_t expected = std::min<int64_t>(schedule.window(), schedule.episodes() - progress.episodes);
  const auto evaluations = static_cast<int64_t>(state.orders.size()) - training;
  const int64_t most = int64_t{schedule.window()} * schedule.evaluation_episodes();
  Expect(training == expected && evaluations <= most,
         fmt::format("expected {} training orders and at most {} evaluations in flight, found {} and {}",
                     expected, most, training, evaluations));
}

/// The figures of evaluations: as many as the world has, of at most as many episodes as an evaluation has.
void Trainer::CheckEvaluations(const TrainingState& state) const {
  const size_t figures = experiment_.world().description().figures.size();
  const PartialEvaluation& partial = state.partial_evaluation;
  Expect(0 <= partial.successes && partial.successes <= partial.episodes &&
             partial.episodes < experiment_.schedule().evaluation_episodes() &&
             partial.figures.size() == (partial.episodes > 0 ? figures : 0) &&
             partial.scores.size() == static_cast<size_t>(partial.episodes),
         fmt::format("an evaluation of {} episodes, {} successes and {} figures", partial.episodes,
                     partial.successes, partial.figures.size()));
  for (const Evaluation* evaluation :
       {state.last_evaluation ? &*state.last_evaluation : nullptr,
        state.best ? &state.best->evaluation : nullptr, state.delivered ? &*state.delivered : nullptr}) {
    const auto episodes = static_cast<size_t>(experiment_.schedule().evaluation_episodes());
    Expect(
        evaluation == nullptr ||
            (evaluation->figures.size() == figures && evaluation->scores.size() == episodes),
        fmt::format("an evaluation without the {} figures of this world and {} scores", figures, episodes));
  }
  Expect(!state.progress.delivering || state.best, "it delivers a best version, but has none");
  Expect((!state.progress.delivering && !state.delivered) ||
             state.progress.episodes == experiment_.schedule().episodes(),
         "it delivers a best version before the training is over");
}

/// Whether the episode is complete and has the sizes of this world.
bool Trainer::Fits(const Episode& episode) const {
  const World& world = experiment_.world();
  const size_t transitions = episode.actions.size();
  return transitions >= 1 && episode.transitions() <= world.longest_episode() &&
         episode.ending != Ending::kNone &&
         episode.states.size() == (transitions + 1) * static_cast<size_t>(world.state_size()) &&
         episode.rewards.size() == transitions &&
         episode.next_masks.size() == transitions * static_cast<size_t>(MaskSize(world.actions())) &&
         std::all_of(episode.actions.begin(), episode.actions.end(),
                     [&](int16_t action) { return action >= 0 && action < world.actions(); });
}

/// Inserts every transition of the episodes at its former index in the ring.
void Trainer::RefillReplay(const TrainingState& state) {
  int64_t count = 0;
  for (const auto& episode : state.replay) {
    Expect(Fits(*episode), "an episode of its replay memory is not one of this world");
    count += episode->transitions();
  }
  const int64_t kept = std::min<int64_t>(state.progress.transitions, experiment_.agent().replay_capacity());
  Expect(state.progress.replay_size == kept && kept <= count && count <= state.progress.transitions,
         fmt::format("expected {} transitions in the replay memory, of {} in all; found {}", kept,
                     state.progress.transitions, count));
  replay_.BeginAt(state.progress.transitions - kept);
  int64_t to_skip = count - kept;  // of the oldest episode, and not in the replay memory any more
  for (const auto& episode : state.replay) {
    const auto first = static_cast<int>(std::min<int64_t>(to_skip, episode->transitions()));
    to_skip -= first;
    ComputeLeastValues(*episode);
    BeginInserting(*episode, first);
    for (int transition = first; transition < episode->transitions(); ++transition) {
      Insert(*episode, transition);
    }
    history_.Add(episode);
  }
}

}  // namespace fresco
