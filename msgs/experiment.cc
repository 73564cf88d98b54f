#include "msgs/experiment.h"

#include <fmt/format.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "core/bytes.h"
#include "core/error.h"
#include "core/files.h"
#include "msgs/channels.h"
#include "msgs/config_reflection.h"
#include "msgs/worlds.h"
#include "nn/mlp.h"
#include "nn/set_network.h"

namespace fresco {
namespace {

using Layers = google::protobuf::RepeatedField<int32_t>;

void FillLayers(Layers& layers, std::initializer_list<int32_t> units) {
  if (layers.empty()) {
    layers.Add(units.begin(), units.end());
  }
}

/// Throws UsageError if the agent has two networks.
void FillNetwork(proto::Agent& agent) {
  if (!agent.has_set_network()) {
    FillLayers(*agent.mutable_hidden_layers(), {200, 256});
    return;
  }
  if (!agent.hidden_layers().empty()) {
    throw UsageError(
        fmt::format("agent.hidden_layers ({} given) and agent.set_network contradict each other; "
                    "allowed: one of the two",
                    agent.hidden_layers_size()));
  }
  FillLayers(*agent.mutable_set_network()->mutable_encoder_layers(), {64, 64});
  FillLayers(*agent.mutable_set_network()->mutable_trunk_layers(), {128, 128});
  FillLayers(*agent.mutable_set_network()->mutable_head_layers(), {64});
}

void FillAgentAndSchedule(proto::ExperimentConfig& config) {
  proto::Agent& agent = *config.mutable_agent();
  FillNetwork(agent);
  if (agent.learning_rate_case() == proto::Agent::LEARNING_RATE_NOT_SET) {
    agent.mutable_exponential();
  }
  agent.mutable_adam();
  proto::Schedule& schedule = *config.mutable_schedule();
  if (schedule.epsilon_case() == proto::Schedule::EPSILON_NOT_SET) {
    schedule.mutable_linear();
  }
  config.mutable_run();
}

std::vector<int> CheckedLayers(const char* field, const Layers& layers) {
  if (layers.size() > kMaximumHiddenLayers) {
    throw UsageError(
        fmt::format("{}: {} layers; allowed: at most {}", field, layers.size(), kMaximumHiddenLayers));
  }
  return {layers.begin(), layers.end()};
}

std::shared_ptr<const Network> MakeNetwork(const proto::Agent& agent, const World& world) {
  if (agent.has_set_network()) {
    const ObservationSets& sets = *world.description().sets;
    const proto::SetNetwork& network = agent.set_network();
    return std::make_shared<SetNetwork>(
        SetShape{sets.own_inputs, sets.items, sets.item_inputs, sets.groups,
                 CheckedLayers("agent.set_network.encoder_layers", network.encoder_layers()),
                 CheckedLayers("agent.set_network.trunk_layers", network.trunk_layers()),
                 CheckedLayers("agent.set_network.head_layers", network.head_layers())});
  }
  std::vector<int> sizes = CheckedLayers("agent.hidden_layers", agent.hidden_layers());
  sizes.insert(sizes.begin(), world.observation_size());
  sizes.push_back(world.actions());
  return std::make_shared<Mlp>(MlpShape(std::move(sizes)));
}

void CheckBatch(const char* field, int64_t columns, const Network& network) {
  const int64_t units = network.units();
  if (columns * units > kMaximumActivations) {
    throw UsageError(fmt::format("{}: {} columns of {} units are too many; allowed: a product of at most {}",
                                 field, columns, units, kMaximumActivations));
  }
}

void CheckNetwork(const Experiment& experiment) {
  const Network& network = *experiment.network();
  if (network.parameter_count() > kMaximumParameters) {
    throw UsageError(fmt::format("{}: {} parameters of the network; allowed: at most {}",
                                 experiment.network_field(), network.parameter_count(), kMaximumParameters));
  }
  CheckBatch("agent.batch_size", experiment.agent().batch_size(), network);
  CheckBatch("run.environments_per_actor", experiment.run().environments_per_actor(), network);
}

/// Calls the function. An error that it throws becomes a UsageError that names the origin.
void WithOrigin(const std::string& origin, const std::function<void()>& function) {
  try {
    function();
  } catch (const Error& error) {
    throw UsageError(origin + ": " + error.what());
  }
}

/// A setting changes the world that a configuration has, and never replaces it by another one.
void CheckSettingKeepsWorld(const proto::ExperimentConfig& config, const std::string& path,
                            const std::string& origin) {
  const auto& descriptor = *proto::ExperimentConfig::descriptor();
  const auto* field = descriptor.FindFieldByName(path.substr(0, path.find_first_of(".[")));
  if (field == nullptr || field->containing_oneof() == nullptr ||
      config.world_case() == proto::ExperimentConfig::WORLD_NOT_SET ||
      config.world_case() == field->number()) {
    return;
  }
  throw UsageError(
      fmt::format("--set {}: the world of {} is {}, and a setting can't replace it; choose a configuration "
                  "of the world {} with --config",
                  path, origin, descriptor.FindFieldByNumber(config.world_case())->name(), field->name()));
}

void Apply(const Settings& settings, const std::string& origin, proto::ExperimentConfig& config) {
  for (const auto& [path, value] : settings) {
    CheckSettingKeepsWorld(config, path, origin);
    SetField(config, path, value);
  }
}

std::string Print(const google::protobuf::Message& message) {
  std::string text;
  google::protobuf::TextFormat::PrintToString(message, &text);
  return text;
}

}  // namespace

Settings ParseSettings(const std::vector<std::string>& arguments) {
  Settings settings;
  for (const std::string& argument : arguments) {
    const size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--set: expected path=value, e.g. schedule.seed=2; found \"" + argument + "\"");
    }
    settings.emplace_back(argument.substr(0, equals), argument.substr(equals + 1));
  }
  return settings;
}

Experiment Experiment::Parse(const std::string& text, const std::string& origin, const Settings& settings) {
  proto::ExperimentConfig config;
  ParseText(text, origin, config);
  const bool reads_files = !NamesFiles(config);  // only what a setting names; otherwise Make refuses it
  Apply(settings, origin, config);
  if (reads_files) {
    WithOrigin(origin, [&] { ReadFiles(config, ""); });
  }
  return Make(std::move(config), origin);
}

std::string Experiment::CodeIn(const std::string& text, const std::string& origin) {
  proto::ExperimentConfig config;
  ParseText(text, origin, config);
  return CodeOf(config);
}

Experiment Experiment::Make(proto::ExperimentConfig given, const std::string& origin) {
  Experiment experiment;
  proto::ExperimentConfig& config = experiment.config_;
  config = std::move(given);
  WithOrigin(origin, [&] {
    CompleteWorld(config);
    FillAgentAndSchedule(config);
  });
  FillDefaults(config);
  CheckRanges(config, origin);
  WithOrigin(origin, [&] {
    ChannelsWithPrefix(config.run().channel_prefix());
    experiment.world_ = MakeWorld(config);
    if (!config.agent().has_discount()) {
      config.mutable_agent()->set_discount(experiment.world().description().discount);
    }
    experiment.network_ = MakeNetwork(config.agent(), experiment.world());
    CheckNetwork(experiment);
  });
  experiment.hash_ = experiment.ComputeHash();
  return experiment;
}

uint32_t Experiment::ComputeHash() const {
  const std::string canonical = CanonicalText();
  return std::max(Crc32c(std::as_bytes(std::span(canonical))), 1u);
}

Experiment Experiment::StartingFrom(std::shared_ptr<const Vector> parameters) const {
  FRESCO_CHECK(parameters->size() == network_->parameter_count());
  Experiment experiment = *this;
  experiment.start_ = std::move(parameters);
  experiment.config_.mutable_agent()->set_start_crc32c(Crc32c(Values(*experiment.start_)));
  experiment.hash_ = experiment.ComputeHash();
  return experiment;
}

Vector Experiment::FirstParameters() const {
  if (!agent().has_start_crc32c()) {
    return network_->InitialParameters(schedule().seed());
  }
  const std::string expected =
      fmt::format("agent.start_crc32c: expected the network from which this run starts, with CRC-32C {:08x}",
                  agent().start_crc32c());
  if (start_ == nullptr) {
    throw UsageError(expected + ", found none; name it with --start-from");
  }
  if (const uint32_t found = Crc32c(Values(*start_)); found != agent().start_crc32c()) {
    throw UsageError(fmt::format("{}, found one with {:08x}", expected, found));
  }
  return *start_;
}

Experiment Experiment::Load(const std::string& path, const Settings& settings) {
  proto::ExperimentConfig config;
  ParseText(ReadFile(path), path, config);
  Apply(settings, path, config);
  WithOrigin(path, [&] { ReadFiles(config, std::filesystem::path(path).parent_path()); });
  return Make(std::move(config), path);
}

std::string Experiment::Text() const {
  return Print(config_);
}

std::string Experiment::WorldText() const {
  proto::ExperimentConfig world = config_;
  world.clear_agent();
  world.clear_schedule();
  world.clear_run();
  return Print(world);
}

std::string Experiment::CanonicalText() const {
  proto::ExperimentConfig deciding = config_;
  deciding.clear_run();
  return Print(deciding);
}

}  // namespace fresco
