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
  state.actions = history_.Actions();
  state.last_evaluation = last_evaluation_;
  state.best = best_;
  return state;
}

void Trainer::Resume(const TrainingState& state) {
  CheckState(state);
  progress_ = state.progress;
  training_orders_ = state.progress.episodes;
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
    training_orders_ += order.order.kind == OrderKind::kTrain ? 1 : 0;
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
             progress.transitions <= progress.episodes * world_->maximum_transitions(),
         fmt::format("{} transitions of {} episodes", progress.transitions, progress.episodes));
  Expect(0 <= progress.updates && progress.updates <= progress.transitions / schedule.inserts_per_update() &&
             state.adam.steps == progress.updates,
         fmt::format("{} updates and {} steps of the optimiser after {} transitions", progress.updates,
                     state.adam.steps, progress.transitions));
  const int64_t whole = progress.updates / schedule.updates_per_version();
  const bool final_version =
      progress.episodes == schedule.episodes() && progress.current_version == whole + 1;
  Expect((progress.current_version == whole || final_version) &&
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
    current = order.current_version;
    target = order.target_version;
    training += order.kind == OrderKind::kTrain;
  }
  const proto::Schedule& schedule = experiment_.schedule();
  const int64_t expected = std::min<int64_t>(schedule.window(), schedule.episodes() - progress.episodes);
  const auto evaluations = static_cast<int64_t>(state.orders.size()) - training;
  Expect(training == expected && evaluations <= schedule.window(),
         fmt::format("expected {} training orders and at most {} evaluations in flight, found {} and {}",
                     expected, schedule.window(), training, evaluations));
}

/// Flies the episodes again and inserts every transition at its former index in the ring.
void Trainer::RefillReplay(const TrainingState& state) {
  const auto count = static_cast<int64_t>(state.actions.size());
  const int64_t kept = std::min<int64_t>(state.progress.transitions, experiment_.agent().replay_capacity());
  Expect(state.progress.replay_size == kept && kept <= count && count <= state.progress.transitions,
         fmt::format("expected the actions of {} transitions in the replay memory, of {} in all; found {}",
                     kept, state.progress.transitions, count));
  replay_.BeginAt(state.progress.transitions - kept);
  std::span<const int16_t> left(state.actions);
  int64_t to_skip = count - kept;  // of the oldest episode, and not in the replay memory any more
  for (Episode episode; !left.empty(); left = left.subspan(static_cast<size_t>(episode.transitions()))) {
    Expect(FlyActions(*world_, experiment_.mask_options(), left, episode),
           fmt::format("the last {} actions of its replay memory are no complete episodes of this scenario",
                       left.size()));
    ComputeLeastValues(episode);
    for (int transition = 0; transition < episode.transitions(); ++transition) {
      history_.Add(episode.actions[static_cast<size_t>(transition)], transition + 1 == episode.transitions());
      if (to_skip > 0) {
        --to_skip;
      } else {
        Insert(episode, transition);
      }
    }
  }
}

}  // namespace fresco
