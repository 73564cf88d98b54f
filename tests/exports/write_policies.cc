// Writes policies of every kind in every format, with states and what Fresco itself computes there, for
// exports_test.py: in a folder for each, policy.network, policy.onnx, policy.h and policy.csv, the binary
// files states, values (single precision), masks (bytes) and actions (int32), and sizes.json.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/files.h"
#include "exports/exports.h"
#include "msgs/experiment.h"
#include "storage/network_file.h"
#include "training/dqn.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

constexpr int kStates = 10'000;

struct Sample {
  const char* name;
  const char* config;
};

// A policy for one field has a network with random parameters: what a training would change is only their
// values.
constexpr Sample kSamples[] = {
    {"field",
     "scenario { sensor { x_m: 200 y_m: 175 } sensor { x_m: 25 y_m: 100 weight: 2 } coverage_radius_m: 100 } "
     "agent { safe_action_mask: true coverage_mask: true }"},
    {"geometry",
     "scenario { random_sensors { count: 4 } } agent { sensor_geometry: true hidden_layers: [64, 32] }"},
    {"sets", "scenario { random_sensors { count: 6 } } agent { set_network {} coverage_mask: true }"},
    {"map",
     "scenario { map_row: \"......\" map_row: \".BB.R.\" map_row: \".BN...\" map_row: \"S....S\" slots: 30 "
     "random_sensors { count: 3 } coverage_radius_m: 60 } "
     "agent { set_network {} safe_action_mask: true coverage_mask: true }"},
    {"fields",
     "scenario { random_sensors { per_episode: true minimum: 1 maximum: 5 } random_field { any_start: true "
     "any_stop: true coverage_radius_m { minimum: 50 maximum: 125 } weight { minimum: 0.5 maximum: 2 } } } "
     "agent { set_network {} safe_action_mask: true coverage_mask: true idle_mask: true }"},
    {"cartpole", "cartpole {}"},
    {"acrobot", "acrobot {}"},
    // A world whose mask only its own code knows.
    {"python", "python { object: \"exported_world:World\" path: \"" FRESCO_SOURCE_DIR "/tests/exports\" }"},
};

/// Fields that are drawn over a map.
constexpr Sample kCity = {
    "city",
    "scenario { map_row: \"......\" map_row: \".BB.R.\" map_row: \"S....S\" slots: 30 "
    "random_sensors { per_episode: true count: 2 } coverage_radius_m: 60 } agent { set_network {} }"};

template <class Number>
std::string_view Bytes(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

void Write(const std::filesystem::path& folder, const Experiment& experiment) {
  std::filesystem::create_directories(folder);
  const World& world = experiment.world();
  const Network& network = *experiment.network();
  Vector parameters = network.InitialParameters(7);
  for (int64_t i = 0; i < parameters.size(); ++i) {
    parameters[i] += 0.01f * static_cast<float>(i % 7 - 3);  // biases, too, are not 0
  }
  const StoredNetwork stored{experiment, 3, 300, parameters};
  WriteFileAtomically(folder / "policy.network", SerializeNetworkFile(stored));
  WriteFileAtomically(folder / "policy.onnx", OnnxModel(stored));
  WriteFileAtomically(folder / "policy.h", CppHeader(stored, "exported"));
  WriteFileAtomically(folder / "policy.csv", ParametersCsv(stored));

  Formulas formulas;
  const bool mask_is_input = !world.Formulate(formulas)->mask;
  const auto workspace = network.NewWorkspace(1, NetworkWorkspace::Passes::kForward);
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  std::vector<float> states;
  std::vector<float> values;
  std::vector<uint8_t> masks;
  std::vector<int32_t> actions;
  for (uint64_t seed = 0; actions.size() < kStates; ++seed) {
    EpisodeRecorder recorder(world, seed);
    while (!recorder.ended() && actions.size() < kStates) {
      world.Observe(recorder.state(),
                    {workspace->input().col(0).data(), static_cast<size_t>(network.inputs())});
      network.Forward(Values(parameters), {0, 1}, *workspace);
      states.insert(states.end(), recorder.state().begin(), recorder.state().end());
      values.insert(values.end(), workspace->output().data(), workspace->output().data() + network.outputs());
      masks.insert(masks.end(), recorder.mask().begin(), recorder.mask().end());
      actions.push_back(GreedyAction(workspace->output(), 0, recorder.mask()));
      recorder.Step(RandomAllowedAction(recorder.mask(), stream));
    }
  }
  WriteFileAtomically(folder / "states", Bytes(states));
  WriteFileAtomically(folder / "values", Bytes(values));
  WriteFileAtomically(folder / "masks", Bytes(masks));
  WriteFileAtomically(folder / "actions", Bytes(actions));
  WriteFileAtomically(folder / "sizes.json", nlohmann::json{{"states", kStates},
                                                            {"fields", world.state_size()},
                                                            {"actions", world.actions()},
                                                            {"parameters", network.parameter_count()},
                                                            {"mask_is_input", mask_is_input}}
                                                 .dump());
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: write_policies FOLDER\n");
    return 2;
  }
  for (const auto& [name, config] : fresco::kSamples) {
    fresco::Write(std::filesystem::path(argv[1]) / name, fresco::Experiment::Parse(config, name));
  }
  const fresco::Experiment city = fresco::Experiment::Parse(fresco::kCity.config, fresco::kCity.name);
  const std::filesystem::path folder = std::filesystem::path(argv[1]) / fresco::kCity.name;
  std::filesystem::create_directories(folder);
  fresco::WriteFileAtomically(
      folder / "policy.network",
      fresco::SerializeNetworkFile({city, 0, 0, city.network()->InitialParameters(1)}));
  return EXIT_SUCCESS;
}
