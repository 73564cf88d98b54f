#include "storage/checkpoint_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/bytes.h"
#include "core/error.h"
#include "core/installation.h"
#include "msgs/proto/checkpoint.pb.h"
#include "training/replay_memory.h"

namespace fresco {
namespace {

constexpr char kCheckpointFamily[] = "fresco-checkpoint-";
constexpr char kCheckpointFormat[] = "fresco-checkpoint-5";

/// Returns the checkpoint in the file after checking its format and CRC.
proto::Checkpoint Unwrap(std::string_view content, const std::string& origin) {
  Expect(content.size() <= std::numeric_limits<int>::max(), origin,
         fmt::format("not a checkpoint of Fresco: {} bytes; allowed: 2 GB", content.size()));
  proto::CheckpointFile file;
  const bool parsed = file.ParseFromArray(content.data(), static_cast<int>(content.size()));
  Expect(parsed || LooksLikeCheckpoint(content), origin, "not a checkpoint of Fresco");
  Expect(parsed, origin, fmt::format("the checkpoint is cut short, at {} bytes", content.size()));
  Expect(file.format().starts_with(kCheckpointFamily), origin, "not a checkpoint of Fresco");
  Expect(file.format() == kCheckpointFormat, origin,
         fmt::format("expected format {}, found {} of Fresco {}; use that release", kCheckpointFormat,
                     file.format(), file.software_version()));
  Expect(Crc32c(std::as_bytes(std::span(file.content()))) == file.crc32c(), origin,
         "the checkpoint is damaged: its CRC is wrong");
  proto::Checkpoint checkpoint;
  Expect(checkpoint.ParseFromString(file.content()), origin,
         "the checkpoint is damaged, though its CRC is right");
  return checkpoint;
}

std::string Bytes(const Vector& vector) {
  const auto bytes = std::as_bytes(Values(vector));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void ToProto(const Evaluation& from, proto::CheckpointEvaluation& to) {
  to.set_version(from.version);
  to.set_updates(from.updates);
  to.set_episodes(from.episodes);
  to.set_success(from.success);
  to.mutable_figures()->Add(from.figures.begin(), from.figures.end());
  to.mutable_scores()->Add(from.scores.begin(), from.scores.end());
}

Evaluation FromProto(const proto::CheckpointEvaluation& from) {
  return {from.version(),
          from.updates(),
          from.episodes(),
          from.success(),
          {from.figures().begin(), from.figures().end()},
          {from.scores().begin(), from.scores().end()}};
}

template <class Value>
std::string BytesOf(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

template <class Value>
std::vector<Value> ValuesOf(const std::string& bytes, const std::string& origin) {
  Expect(bytes.size() % sizeof(Value) == 0, origin, fmt::format("replay: found {} bytes", bytes.size()));
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

void ToProto(const Episode& from, bool repeatable, proto::CheckpointEpisode& to) {
  to.set_seed(from.seed);
  to.set_ending(static_cast<int>(from.ending));
  to.set_actions(BytesOf(from.actions));
  if (!repeatable) {
    to.set_states(BytesOf(from.states));
    to.set_rewards(BytesOf(from.rewards));
    to.set_next_masks(BytesOf(from.next_masks));
  }
}

std::shared_ptr<const Episode> FromProto(const proto::CheckpointEpisode& from, const World& world,
                                         const std::string& origin) {
  auto episode = std::make_shared<Episode>();
  const auto actions = ValuesOf<int16_t>(from.actions(), origin);
  if (world.description().repeatable) {
    const bool possible =
        FlyActions(world, from.seed(), actions, *episode) && episode->actions.size() == actions.size();
    Expect(possible, origin, "replay: found actions that are no complete episode of this world");
  } else {
    Expect(from.ending() == static_cast<int>(Ending::kTerminal) ||
               from.ending() == static_cast<int>(Ending::kTruncated),
           origin, fmt::format("replay: found an episode with the ending {}", from.ending()));
    *episode = {
        from.seed(), static_cast<Ending>(from.ending()),      ValuesOf<float>(from.states(), origin),
        actions,     ValuesOf<float>(from.rewards(), origin), ValuesOf<uint8_t>(from.next_masks(), origin)};
  }
  Expect(std::all_of(episode->states.begin(), episode->states.end(),
                     [](float value) { return std::isfinite(value); }),
         origin, "replay: found a state that is not finite");
  return episode;
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
  to.set_delivering(from.delivering);
}

TrainerProgress FromProto(const proto::CheckpointProgress& from) {
  return {from.committed_orders(),  from.episodes(),
          from.transitions(),       from.updates(),
          from.replay_size(),       from.current_version(),
          from.target_version(),    from.epsilon(),
          from.learning_rate(),     from.loss(),
          from.staleness_updates(), from.delivering()};
}

void ToProto(const OrderInFlight& from, proto::CheckpointOrder& to) {
  to.set_index(from.order.index);
  to.set_evaluate(from.order.kind == OrderKind::kEvaluate);
  to.set_epsilon(from.order.epsilon);
  to.set_search_width(from.order.search_width);
  to.set_search_from(from.order.search_from);
  to.set_seed(from.order.seed);
  to.set_current_version(from.order.current_version);
  to.set_target_version(from.order.target_version);
  to.set_updates_at_writing(from.updates_at_writing);
}

OrderInFlight FromProto(const proto::CheckpointOrder& from) {
  return {
      {from.index(), from.evaluate() ? OrderKind::kEvaluate : OrderKind::kTrain, from.epsilon(),
       from.search_width(), from.search_from(), from.seed(), from.current_version(), from.target_version()},
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

/// Sets the fields of `to` that hold the state.
void WriteTrainingState(const TrainingState& from, bool repeatable, proto::Checkpoint& to) {
  ToProto(from.progress, *to.mutable_progress());
  for (const OrderInFlight& order : from.orders) {
    ToProto(order, *to.add_orders());
  }
  for (const VersionState& version : from.versions) {
    proto::CheckpointVersion& entry = *to.add_versions();
    entry.set_target(version.version.kind == NetworkKind::kTarget);
    entry.set_version(version.version.number);
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
  for (const auto& episode : from.replay) {
    ToProto(*episode, repeatable, *to.add_replay());
  }
  if (from.partial_evaluation.episodes > 0) {
    proto::CheckpointPartialEvaluation& partial = *to.mutable_partial_evaluation();
    partial.set_episodes(from.partial_evaluation.episodes);
    partial.set_successes(from.partial_evaluation.successes);
    partial.mutable_figures()->Add(from.partial_evaluation.figures.begin(),
                                   from.partial_evaluation.figures.end());
    partial.mutable_scores()->Add(from.partial_evaluation.scores.begin(),
                                  from.partial_evaluation.scores.end());
  }
  if (from.last_evaluation) {
    ToProto(*from.last_evaluation, *to.mutable_last_evaluation());
  }
  if (from.best) {
    ToProto(from.best->evaluation, *to.mutable_best_evaluation());
    to.set_best_parameters(Bytes(*from.best->parameters));
  }
  if (from.delivered) {
    ToProto(*from.delivered, *to.mutable_delivered_evaluation());
  }
}

/// Reads the state of a training of this experiment. Throws UsageError that names
/// `origin` and the field if a size is wrong.
TrainingState ReadTrainingState(const proto::Checkpoint& from, const Experiment& experiment,
                                const std::string& origin) {
  const VectorReader reader(experiment.network()->parameter_count(), origin);
  TrainingState to;
  to.progress = FromProto(from.progress());
  for (const proto::CheckpointOrder& order : from.orders()) {
    to.orders.push_back(FromProto(order));
  }
  for (const proto::CheckpointVersion& version : from.versions()) {
    to.versions.push_back(
        {{version.target() ? NetworkKind::kTarget : NetworkKind::kCurrent, version.version()},
         version.updates(),
         reader.ReadShared(version.parameters(), "versions")});
  }
  to.current = reader.Read(from.current(), "current");
  to.target = reader.Read(from.target(), "target");
  to.adam = {from.adam_steps(), from.adam_beta1_power(), from.adam_beta2_power(),
             reader.Read(from.adam_first_moment(), "adam_first_moment"),
             reader.Read(from.adam_second_moment(), "adam_second_moment")};
  for (const proto::CheckpointEpisode& episode : from.replay()) {
    to.replay.push_back(FromProto(episode, experiment.world(), origin));
  }
  if (from.has_partial_evaluation()) {
    const proto::CheckpointPartialEvaluation& partial = from.partial_evaluation();
    to.partial_evaluation = {partial.episodes(),
                             partial.successes(),
                             {partial.figures().begin(), partial.figures().end()},
                             {partial.scores().begin(), partial.scores().end()}};
  }
  if (from.has_last_evaluation()) {
    to.last_evaluation = FromProto(from.last_evaluation());
  }
  if (from.has_best_evaluation()) {
    to.best = {FromProto(from.best_evaluation()),
               reader.ReadShared(from.best_parameters(), "best_parameters")};
  }
  if (from.has_delivered_evaluation()) {
    to.delivered = FromProto(from.delivered_evaluation());
  }
  return to;
}

}  // namespace

std::string SerializeCheckpoint(const Checkpoint& checkpoint) {
  proto::Checkpoint to;
  to.set_run_id(checkpoint.run_id);
  to.set_arithmetic_fingerprint(checkpoint.arithmetic_fingerprint);
  to.set_config_hash(checkpoint.experiment.hash());
  to.set_config_text(checkpoint.experiment.Text());
  WriteTrainingState(checkpoint.training, checkpoint.experiment.world().description().repeatable, to);
  to.set_resumptions(checkpoint.resumptions);
  to.set_wall_s(checkpoint.wall_s);
  to.set_metrics(checkpoint.metrics);
  for (const auto& [name, value] : checkpoint.counters) {
    proto::CheckpointCounter& counter = *to.add_counters();
    counter.set_name(name);
    counter.set_value(value);
  }
  constexpr size_t kLargest = (size_t{1} << 31) - (1 << 20);
  if (to.ByteSizeLong() > kLargest) {
    throw Failure(
        fmt::format("a checkpoint of this run is too large: {} bytes; allowed: {} (Protobuf's limit)",
                    to.ByteSizeLong(), kLargest));
  }
  proto::CheckpointFile file;
  file.set_format(kCheckpointFormat);
  file.set_software_version(kSoftwareVersion);
  to.SerializeToString(file.mutable_content());
  file.set_crc32c(Crc32c(std::as_bytes(std::span(file.content()))));
  return file.SerializeAsString();
}

int64_t CheckpointBytes(int64_t parameters, int64_t versions, int64_t episode_bytes) {
  constexpr int64_t kCopies = 3;  // Protobuf's message, its content, the file
  constexpr int64_t kCopied = 4;  // current and target network, Adam's moments; others are shared
  constexpr int64_t kBest = 1;    // the best evaluated network
  const int64_t network = parameters * static_cast<int64_t>(sizeof(Vector::Scalar));
  return kCopied * network + kCopies * ((kCopied + kBest + versions) * network + episode_bytes);
}

int64_t CheckpointedEpisodeBytes(const World& world, int64_t transitions) {
  return world.description().repeatable ? transitions * static_cast<int64_t>(sizeof(int16_t))
                                        : EpisodeHistory::BytesFor(world, transitions);
}

bool LooksLikeCheckpoint(std::string_view content) {
  // The format is the file's first field: a tag and a length before it.
  constexpr size_t kBefore = 2;
  return content.size() > kBefore && content.substr(kBefore).starts_with(kCheckpointFamily);
}

Checkpoint ParseCheckpoint(std::string_view content, const std::string& origin) {
  const proto::Checkpoint from = Unwrap(content, origin);
  Experiment experiment = Experiment::Parse(from.config_text(), origin + " (its configuration)");
  Expect(experiment.hash() == from.config_hash(), origin,
         fmt::format("its configuration has hash {:08x}, expected {:08x}", experiment.hash(),
                     from.config_hash()));
  TrainingState training = ReadTrainingState(from, experiment, origin);
  Checkpoint checkpoint{std::move(experiment), from.arithmetic_fingerprint(), from.run_id(),
                        std::move(training)};
  checkpoint.resumptions = from.resumptions();
  checkpoint.wall_s = from.wall_s();
  checkpoint.metrics = from.metrics();
  for (const proto::CheckpointCounter& counter : from.counters()) {
    checkpoint.counters[counter.name()] = counter.value();
  }
  return checkpoint;
}

}  // namespace fresco
