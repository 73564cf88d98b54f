#include "logs/retraining.h"

#include <fmt/format.h>

#include <utility>

#include "core/bytes.h"
#include "core/error.h"

namespace fresco {

Retraining::Retraining(const Experiment& experiment, LoggedEpisodes& episodes, Use use, bool strict,
                       EvaluationHandler evaluated)
    : experiment_(experiment),
      episodes_(&episodes),
      use_(use),
      strict_(strict),
      flyer_(experiment, static_cast<int>(MaximumOrdersInFlight(experiment.schedule()))),
      trainer_(experiment, Output(std::move(evaluated)), LearnerThreads(experiment.run())) {
  if (use == Use::kExperience) {
    const std::vector<int64_t> training = episodes.Training();
    experience_.assign(training.begin(), training.end());
    const auto recorded = static_cast<int64_t>(experience_.size());
    if (recorded < experiment.schedule().episodes()) {
      throw UsageError(fmt::format(
          "schedule.episodes is {}, but the log contains only {} complete training episodes: record a longer "
          "run, or train on these with --set schedule.episodes={}",
          experiment.schedule().episodes(), recorded, recorded));
    }
  }
  trainer_.Begin();
}

TrainerOutput Retraining::Output(EvaluationHandler evaluated) {
  TrainerOutput output;
  output.order = [this](const Order& order) { AddOrder(order); };
  output.version = [this](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
    KeepVersion(version.kind, version.number, std::move(parameters));
  };
  output.evaluation = [this, evaluated = std::move(evaluated)](const Evaluation& evaluation) {
    evaluated(trainer_, evaluation);
  };
  return output;
}

void Retraining::KeepVersion(NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters) {
  if (use_ == Use::kSameRun) {
    if (const auto recorded = episodes_->WeightsCrc(kind, version)) {
      const std::span values(parameters->data(), static_cast<size_t>(parameters->size()));
      ++counts_.compared_versions;
      if (Crc32c(values) != *recorded && counts_.different_versions++ == 0) {
        counts_.first_different_version = version;
      }
    }
  }
  (kind == NetworkKind::kCurrent ? current_ : target_) = std::move(parameters);
}

bool Retraining::IsRecorded(const Order& order) const {
  return use_ == Use::kSameRun ? episodes_->whole().contains(order.index) : order.kind == OrderKind::kTrain;
}

void Retraining::AddOrder(const Order& order) {
  const bool is_recorded = IsRecorded(order);
  if (!is_recorded) {
    if (strict_ && use_ == Use::kSameRun) {
      throw Failure(
          fmt::format("--strict: the log misses the episode of order {}; without --strict it would be flown "
                      "again",
                      order.index));
    }
    flyer_.Start(order, current_, target_);
  }
  pending_.push_back({order, !is_recorded});
}

bool Retraining::Step() {
  if (pending_.empty()) {
    return false;
  }
  Episode episode = EpisodeOf(pending_.front());
  const Order order = pending_.front().order;
  pending_.pop_front();
  trainer_.Commit(order, std::move(episode));
  return true;
}

Episode Retraining::EpisodeOf(const PendingOrder& pending) {
  if (pending.is_flown) {
    ++(use_ == Use::kSameRun ? counts_.flown_again : counts_.evaluations_flown);
    return WaitForFlight(pending);
  }
  ++counts_.recorded_episodes;
  return use_ == Use::kSameRun ? episodes_->Take(pending.order.index).episode : NextExperience();
}

/// Flies until the flight of this order, the first pending one, has ended.
Episode Retraining::WaitForFlight(const PendingOrder& pending) {
  while (!pending.flown) {
    flyer_.Step([this](const Order& order, const OrderResult& result) {
      const int64_t position = order.index - pending_.front().order.index;
      pending_[static_cast<size_t>(position)].flown = result.episode;
    });
  }
  return *pending.flown;
}

/// Returns the next recorded training episode that this agent's masks allow.
Episode Retraining::NextExperience() {
  const World& world = experiment_.world();
  while (!experience_.empty()) {
    CommittedEpisode recorded = episodes_->Take(experience_.front());
    experience_.pop_front();
    if (!world.description().repeatable) {
      return recorded.episode;
    }
    Episode episode;
    if (FlyActions(world, recorded.order.seed, recorded.episode.actions, episode)) {
      return episode;
    }
    ++counts_.left_out;
  }
  throw Failure(fmt::format(
      "the recorded experience has run out after {} episodes: {} more have actions that the masks of this "
      "configuration forbid",
      counts_.recorded_episodes - 1, counts_.left_out));
}

}  // namespace fresco
