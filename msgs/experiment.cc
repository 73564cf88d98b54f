#include "msgs/experiment.h"

#include <fmt/format.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/bytes.h"
#include "core/error.h"
#include "core/files.h"
#include "msgs/channels.h"
#include "msgs/config_reflection.h"
#include "msgs/worlds.h"

namespace fresco {
namespace {

void FillAgentAndSchedule(proto::ExperimentConfig& config) {
  proto::Agent& agent = *config.mutable_agent();
  if (agent.hidden_layers().empty()) {
    agent.add_hidden_layers(200);
    agent.add_hidden_layers(256);
  }
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

void CheckBatch(const char* field, int64_t columns, const MlpShape& shape) {
  const std::vector<int>& sizes = shape.layer_sizes();
  const int64_t units = std::accumulate(sizes.begin(), sizes.end(), int64_t{0});
  if (columns * units > kMaximumActivations) {
    throw UsageError(fmt::format("{}: {} columns of {} units are too many; allowed: a product of at most {}",
                                 field, columns, units, kMaximumActivations));
  }
}

void CheckNetwork(const Experiment& experiment) {
  const int layers = experiment.agent().hidden_layers_size();
  if (layers > kMaximumHiddenLayers) {
    throw UsageError(
        fmt::format("agent.hidden_layers: {} layers; allowed: at most {}", layers, kMaximumHiddenLayers));
  }
  const MlpShape shape = experiment.network_shape();
  if (shape.parameter_count() > kMaximumParameters) {
    throw UsageError(fmt::format("agent.hidden_layers: {} parameters of the network; allowed: at most {}",
                                 shape.parameter_count(), kMaximumParameters));
  }
  CheckBatch("agent.batch_size", experiment.agent().batch_size(), shape);
  CheckBatch("run.environments_per_actor", experiment.run().environments_per_actor(), shape);
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
  for (const auto& [path, value] : settings) {
    CheckSettingKeepsWorld(config, path, origin);
    SetField(config, path, value);
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
  WithOrigin(origin, [&] { CompleteWorld(config); });
  FillAgentAndSchedule(config);
  FillDefaults(config);
  CheckRanges(config, origin);
  WithOrigin(origin, [&] {
    ChannelsWithPrefix(config.run().channel_prefix());
    experiment.world_ = MakeWorld(config);
    if (!config.agent().has_discount()) {
      config.mutable_agent()->set_discount(experiment.world().description().discount);
    }
    CheckNetwork(experiment);
  });
  const std::string canonical = experiment.CanonicalText();
  experiment.hash_ = std::max(Crc32c(std::as_bytes(std::span(canonical))), 1u);
  return experiment;
}

Experiment Experiment::Load(const std::string& path, const Settings& settings) {
  return Parse(ReadFile(path), path, settings);
}

MlpShape Experiment::network_shape() const {
  std::vector<int> sizes = {world().observation_size()};
  sizes.insert(sizes.end(), agent().hidden_layers().begin(), agent().hidden_layers().end());
  sizes.push_back(world().actions());
  return MlpShape(sizes);
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
