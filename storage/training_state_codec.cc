#include "storage/training_state_codec.h"

#include <fmt/format.h>

#include <cstring>
#include <limits>

#include "core/error.h"

namespace fresco {
namespace {

std::string Bytes(const Vector& vector) {
  return {reinterpret_cast<const char*>(vector.data()), static_cast<size_t>(vector.size()) * sizeof(float)};
}

void ToProto(const Evaluation& from, proto::CheckpointEvaluation& to) {
  to.set_version(from.version);
  to.set_updates(from.updates);
  to.set_episodes(from.episodes);
  to.set_arrived(from.arrived);
  to.set_total_aoi(from.figures.total_aoi);
  to.set_average_aoi(from.figures.average_aoi);
  to.set_sum_aoi(from.figures.sum_aoi);
}

Evaluation FromProto(const proto::CheckpointEvaluation& from) {
  return {from.version(),
          from.updates(),
          from.episodes(),
          from.arrived(),
          {from.total_aoi(), from.average_aoi(), from.sum_aoi()}};
}

void ToProto(const TrainerProgress& from, proto::CheckpointProgress& to) {
  to.set_committed_orders(from.committed_orders);
  to.set_episodes(from.episodes);
  to.set_transitions(from.transitions);
  to.set_updates(from.updates);
  to.set_replay_size(from.replay_size);
  to.set_current_version(from.current_version);
  to.set_target_version(from.target_version);
  to.set_epsilon(from.epsilon);
  to.set_learning_rate(from.learning_rate);
  to.set_loss(from.loss);
  to.set_staleness_updates(from.staleness_updates);
}

TrainerProgress FromProto(const proto::CheckpointProgress& from) {
  return {from.committed_orders(), from.episodes(),
          from.transitions(),      from.updates(),
          from.replay_size(),      from.current_version(),
          from.target_version(),   from.epsilon(),
          from.learning_rate(),    from.loss(),
          from.staleness_updates()};
}

void ToProto(const OrderInFlight& from, proto::CheckpointOrder& to) {
  to.set_index(from.order.index);
  to.set_evaluate(from.order.kind == OrderKind::kEvaluate);
  to.set_epsilon(from.order.epsilon);
  to.set_seed(from.order.seed);
  to.set_current_version(from.order.current_version);
  to.set_target_version(from.order.target_version);
  to.set_updates_at_writing(from.updates_at_writing);
}

OrderInFlight FromProto(const proto::CheckpointOrder& from) {
  return {{from.index(), from.evaluate() ? OrderKind::kEvaluate : OrderKind::kTrain, from.epsilon(),
           from.seed(), from.current_version(), from.target_version()},
          from.updates_at_writing()};
}

/// Reads the vectors of one checkpoint, which all have the same size.
class VectorReader {
 public:
  VectorReader(int64_t parameters, std::string origin)
      : parameters_(parameters), origin_(std::move(origin)) {}

  Vector Read(const std::string& bytes, const char* what) const {
    const size_t expected = static_cast<size_t>(parameters_) * sizeof(float);
    Expect(bytes.size() == expected, origin_,
           fmt::format("{}: expected {} bytes, found {}", what, expected, bytes.size()));
    Vector vector(parameters_);
    std::memcpy(vector.data(), bytes.data(), expected);
    return vector;
  }
  std::shared_ptr<const Vector> ReadShared(const std::string& bytes, const char* what) const {
    return std::make_shared<const Vector>(Read(bytes, what));
  }

 private:
  int64_t parameters_;
  std::string origin_;
};

std::vector<int16_t> ReadActions(const proto::Checkpoint& from, const std::string& origin) {
  std::vector<int16_t> actions;
  actions.reserve(static_cast<size_t>(from.actions_size()));
  for (const int32_t action : from.actions()) {
    Expect(action >= 0 && action <= std::numeric_limits<int16_t>::max(), origin,
           fmt::format("actions: found {}", action));
    actions.push_back(static_cast<int16_t>(action));
  }
  return actions;
}

}  // namespace

void WriteTrainingState(const TrainingState& from, proto::Checkpoint& to) {
  ToProto(from.progress, *to.mutable_progress());
  for (const OrderInFlight& order : from.orders) {
    ToProto(order, *to.add_orders());
  }
  for (const VersionState& version : from.versions) {
    proto::CheckpointVersion& entry = *to.add_versions();
    entry.set_target(version.kind == NetworkKind::kTarget);
    entry.set_version(version.version);
    entry.set_updates(version.updates);
    entry.set_parameters(Bytes(*version.parameters));
  }
  to.set_current(Bytes(from.current));
  to.set_target(Bytes(from.target));
  to.set_adam_steps(from.adam.steps);
  to.set_adam_beta1_power(from.adam.beta1_power);
  to.set_adam_beta2_power(from.adam.beta2_power);
  to.set_adam_first_moment(Bytes(from.adam.first_moment));
  to.set_adam_second_moment(Bytes(from.adam.second_moment));
  to.mutable_actions()->Add(from.actions.begin(), from.actions.end());
  if (from.last_evaluation) {
    ToProto(*from.last_evaluation, *to.mutable_last_evaluation());
  }
  if (from.best) {
    ToProto(from.best->evaluation, *to.mutable_best_evaluation());
    to.set_best_parameters(Bytes(*from.best->parameters));
  }
}

TrainingState ReadTrainingState(const proto::Checkpoint& from, int64_t parameters,
                                const std::string& origin) {
  const VectorReader reader(parameters, origin);
  TrainingState to;
  to.progress = FromProto(from.progress());
  for (const proto::CheckpointOrder& order : from.orders()) {
    to.orders.push_back(FromProto(order));
  }
  for (const proto::CheckpointVersion& version : from.versions()) {
    to.versions.push_back({version.target() ? NetworkKind::kTarget : NetworkKind::kCurrent, version.version(),
                           version.updates(), reader.ReadShared(version.parameters(), "versions")});
  }
  to.current = reader.Read(from.current(), "current");
  to.target = reader.Read(from.target(), "target");
  to.adam = {from.adam_steps(), from.adam_beta1_power(), from.adam_beta2_power(),
             reader.Read(from.adam_first_moment(), "adam_first_moment"),
             reader.Read(from.adam_second_moment(), "adam_second_moment")};
  to.actions = ReadActions(from, origin);
  if (from.has_last_evaluation()) {
    to.last_evaluation = FromProto(from.last_evaluation());
  }
  if (from.has_best_evaluation()) {
    to.best = {FromProto(from.best_evaluation()),
               reader.ReadShared(from.best_parameters(), "best_parameters")};
  }
  return to;
}

}  // namespace fresco
