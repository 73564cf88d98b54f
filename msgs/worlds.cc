#include "msgs/worlds.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "core/error.h"
#include "msgs/experiment.h"
#include "msgs/flight_messages.h"
#include "msgs/plugin_config.h"
#include "msgs/proto/options.pb.h"
#include "msgs/uav_config.h"
#include "worlds/acrobot/acrobot.h"
#include "worlds/cartpole/cartpole.h"
#include "worlds/uav/uav_fields.h"

namespace fresco {
namespace {

using google::protobuf::FieldDescriptor;
using Config = proto::ExperimentConfig;

/// What viewers get of a kind of world. The worlds are of this kind.
struct ViewerMessages {
  std::vector<scenario_t> (*of_world)(const World&);
  std::vector<scenario_t> (*of_episodes_world)(const World&, const Episode&);
  std::vector<flight_t> (*of_episode)(const World&, const Episode&, const std::string& policy);
};

struct WorldKind {
  Config::WorldCase world;  // the field that has its configuration
  std::shared_ptr<const World> (*make)(const Config&);
  void (*complete)(Config&) = nullptr;
  std::string (*code)(const Config&) = nullptr;  // see CodeOf
  const ViewerMessages* viewer_messages = nullptr;
  bool (*names_files)(const Config&) = nullptr;  // see NamesFiles, ReadFiles
  void (*read_files)(Config&, const std::filesystem::path& folder) = nullptr;
};

template <class BuiltIn>
std::shared_ptr<const World> Make(const proto::BuiltInWorld& config) {
  return std::make_shared<BuiltIn>(config.maximum_steps());
}

constexpr ViewerMessages kUavMessages = {
    [](const World& world) {
      const UavWorld* field = AsUavWorld(world);
      return field != nullptr ? ScenarioMessages(*field) : std::vector<scenario_t>();
    },
    [](const World& world, const Episode& episode) {
      return ScenarioMessages(*OverItsField(world, episode).field);
    },
    [](const World& world, const Episode& episode, const std::string& policy) {
      const FlightOverField over = OverItsField(world, episode);
      return FlightMessages(*over.field, over.flight, policy);
    }};

const WorldKind kWorldKinds[] = {
    {Config::kScenario, MakeUavWorld, CompleteScenario, nullptr, &kUavMessages, NamesMap, ReadMap},
    {Config::kCartpole, [](const Config& config) { return Make<CartPole>(config.cartpole()); }},
    {Config::kAcrobot, [](const Config& config) { return Make<Acrobot>(config.acrobot()); }},
    {Config::kPlugin, MakePluginWorld, CompletePlugin, PluginCode},
    {Config::kPython, MakePythonWorld, CompletePython, PythonCode},
};

const WorldKind& KindOf(const Config& config) {
  const auto found = std::find_if(std::begin(kWorldKinds), std::end(kWorldKinds),
                                  [&](const WorldKind& kind) { return kind.world == config.world_case(); });
  FRESCO_CHECK(found != std::end(kWorldKinds));
  return *found;
}

/// Throws UsageError if the agent has an option that is only for another world.
void CheckOnlyFor(const Config& config) {
  const std::string& world = Config::descriptor()->FindFieldByNumber(config.world_case())->name();
  for (int i = 0; i < proto::Agent::descriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *proto::Agent::descriptor()->field(i);
    const std::string& only_for = field.options().GetExtension(proto::only_for);
    if (!only_for.empty() && only_for != world &&
        config.agent().GetReflection()->GetBool(config.agent(), &field)) {
      throw UsageError(
          fmt::format("agent.{}: true; allowed: false, since only the world {} has this option and "
                      "the world is {}",
                      field.name(), only_for, world));
    }
  }
}

void CheckCapabilities(const Config& config, const World& world) {
  const std::string& name = world.description().name;
  if (config.schedule().excursion_share() > 0 && !world.has_places()) {
    throw UsageError(
        fmt::format("schedule.excursion_share: {} is out of range; allowed: 0, since the world {} has "
                    "no places to set out for",
                    config.schedule().excursion_share(), name));
  }
  if (config.schedule().has_search() && !world.description().copies) {
    throw UsageError(
        fmt::format("schedule.search: set; allowed: omitted, since the environments of the world {} can't be "
                    "copied, and a search follows many episodes side by side",
                    name));
  }
  if (config.agent().flown_return_bound() && world.description().chance) {
    throw UsageError(
        fmt::format("agent.flown_return_bound: true; allowed: false, since in the world {} chance "
                    "decides what an episode earns",
                    name));
  }
  if (config.agent().has_set_network() && !world.description().sets) {
    throw UsageError(
        fmt::format("agent.set_network: set; allowed: omitted, since the world {} has no observation that is "
                    "made of a set of items",
                    name));
  }
}

}  // namespace

bool NamesFiles(const Config& config) {
  return config.world_case() != Config::WORLD_NOT_SET && KindOf(config).names_files != nullptr &&
         KindOf(config).names_files(config);
}

void ReadFiles(Config& config, const std::filesystem::path& folder) {
  if (NamesFiles(config)) {
    KindOf(config).read_files(config, folder);
  }
}

void CompleteWorld(Config& config) {
  if (config.world_case() == Config::WORLD_NOT_SET) {
    config.mutable_scenario();
  }
  if (const auto complete = KindOf(config).complete) {
    complete(config);
  }
}

std::string CodeOf(const Config& config) {
  const bool has_code = config.world_case() != Config::WORLD_NOT_SET && KindOf(config).code != nullptr;
  return has_code ? KindOf(config).code(config) : "";
}

std::shared_ptr<const World> MakeWorld(const Config& config) {
  CheckOnlyFor(config);
  std::shared_ptr<const World> world = KindOf(config).make(config);
  CheckCapabilities(config, *world);
  return world;
}

bool HasFlights(const Experiment& experiment) {
  return KindOf(experiment.config()).viewer_messages != nullptr;
}

std::vector<scenario_t> ScenarioMessages(const Experiment& experiment) {
  return HasFlights(experiment) ? KindOf(experiment.config()).viewer_messages->of_world(experiment.world())
                                : std::vector<scenario_t>();
}

std::vector<scenario_t> ScenarioMessages(const Experiment& experiment, const Episode& episode) {
  FRESCO_CHECK(HasFlights(experiment));
  return KindOf(experiment.config()).viewer_messages->of_episodes_world(experiment.world(), episode);
}

std::vector<flight_t> FlightMessages(const Experiment& experiment, const Episode& episode,
                                     const std::string& policy) {
  FRESCO_CHECK(HasFlights(experiment));
  return KindOf(experiment.config()).viewer_messages->of_episode(experiment.world(), episode, policy);
}

}  // namespace fresco
