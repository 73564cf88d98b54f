#include "msgs/experiment.h"

#include <fmt/format.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <numeric>

#include "core/bytes.h"
#include "core/error.h"
#include "core/files.h"
#include "msgs/channels.h"
#include "msgs/config_reflection.h"
#include "msgs/wire.h"
#include "worlds/uav/physics.h"
#include "worlds/uav/world.h"

namespace fresco {
namespace {

void SetCell(proto::Cell& cell, int column, int row) {
  cell.set_column(column);
  cell.set_row(row);
}

/// Fills in what Protobuf's field defaults can't express: submessages, and one choice of each oneof.
void FillScenario(proto::Scenario& scenario) {
  scenario.mutable_grid();
  scenario.mutable_radio();
  scenario.mutable_rotor();
  scenario.mutable_reward();
  if (!scenario.has_start()) {
    SetCell(*scenario.mutable_start(), 10, 0);
  }
  if (!scenario.has_stop()) {
    SetCell(*scenario.mutable_stop(), 10, 19);
  }
  SetCell(*scenario.mutable_start(), scenario.start().column(), scenario.start().row());
  SetCell(*scenario.mutable_stop(), scenario.stop().column(), scenario.stop().row());
  if (scenario.sensor().empty()) {
    scenario.mutable_random_sensors();
  }
  if (scenario.coverage_case() == proto::Scenario::COVERAGE_NOT_SET) {
    scenario.set_coverage_radius_m(100);
  }
}

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

void CheckAlternatives(const proto::ExperimentConfig& config, const std::string& origin) {
  if (config.scenario().has_random_sensors() && !config.scenario().sensor().empty()) {
    throw UsageError(
        fmt::format("{}: scenario.sensor ({} given) and scenario.random_sensors contradict each other; "
                    "allowed: one of the two",
                    origin, config.scenario().sensor_size()));
  }
}

Rotor ToRotor(const proto::Rotor& rotor) {
  return {rotor.blade_profile_power_w(),
          rotor.induced_power_w(),
          rotor.tip_speed_mps(),
          rotor.induced_velocity_mps(),
          rotor.drag_ratio(),
          rotor.air_density_kgpm3(),
          rotor.solidity(),
          rotor.disk_area_m2()};
}

Scenario ToScenario(const proto::Scenario& from) {
  Scenario scenario;
  scenario.columns = from.grid().columns();
  scenario.rows = from.grid().rows();
  scenario.cell_m = from.grid().cell_m();
  scenario.slots = from.slots();
  scenario.slot_s = from.slot_s();
  scenario.start = {from.start().column(), from.start().row()};
  scenario.stop = {from.stop().column(), from.stop().row()};
  for (const proto::Sensor& sensor : from.sensor()) {
    scenario.sensors.push_back({sensor.x_m(), sensor.y_m(), sensor.weight()});
  }
  if (from.has_random_sensors()) {
    scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m,
                                     from.random_sensors().count(), from.random_sensors().seed());
  }
  scenario.radio = {from.radio().bandwidth_hz(), from.radio().update_bits(), from.radio().noise_dbm(),
                    from.radio().gain_at_1m_db(), from.radio().altitude_m()};
  scenario.coverage_radius_m = from.has_transmit_power_w()
                                   ? CoverageRadius(scenario.radio, scenario.slot_s, from.transmit_power_w())
                                   : from.coverage_radius_m();
  scenario.initial_energy_j = from.initial_energy_j();
  scenario.rotor = ToRotor(from.rotor());
  scenario.speed_mps = from.speed_mps();
  scenario.reward = {from.reward().k1(), from.reward().k2(), from.reward().k3()};
  if (from.has_maximum_aoi()) {
    scenario.maximum_aoi = from.maximum_aoi();
  }
  return scenario;
}

Scenario CheckedScenario(const proto::Scenario& from) {
  Scenario scenario = ToScenario(from);
  const World checked(scenario);
  return scenario;
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
    SetField(config, path, value);
  }
  return Make(std::move(config), origin);
}

Experiment Experiment::Make(proto::ExperimentConfig given, const std::string& origin) {
  Experiment experiment;
  proto::ExperimentConfig& config = experiment.config_;
  config = std::move(given);
  FillScenario(*config.mutable_scenario());
  FillAgentAndSchedule(config);
  FillDefaults(config);
  CheckAlternatives(config, origin);
  CheckRanges(config, origin);
  try {
    ChannelsWithPrefix(config.run().channel_prefix());
    experiment.scenario_ = CheckedScenario(config.scenario());
    CheckNetwork(experiment);
  } catch (const Error& error) {
    throw UsageError(origin + ": " + error.what());
  }
  const std::string canonical = experiment.CanonicalText();
  experiment.hash_ = std::max(Crc32c(std::as_bytes(std::span(canonical))), 1u);
  return experiment;
}

Experiment Experiment::Load(const std::string& path, const Settings& settings) {
  return Parse(ReadFile(path), path, settings);
}

MlpShape Experiment::network_shape() const {
  const int sensors = static_cast<int>(scenario_.sensors.size());
  std::vector<int> sizes = {NetworkInput::Size(sensors, network_input_options())};
  sizes.insert(sizes.end(), agent().hidden_layers().begin(), agent().hidden_layers().end());
  sizes.push_back(kMoves * (sensors + 1));
  return MlpShape(sizes);
}

MaskOptions Experiment::mask_options() const {
  return {agent().safe_action_mask(), agent().coverage_mask()};
}

std::string Experiment::Text() const {
  return Print(config_);
}

std::string Experiment::CanonicalText() const {
  proto::ExperimentConfig deciding = config_;
  deciding.clear_run();
  return Print(deciding);
}

}  // namespace fresco
