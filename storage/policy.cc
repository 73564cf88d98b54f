#include "storage/policy.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "nn/arithmetic_option.h"
#include "storage/checkpoint_file.h"
#include "storage/run_folder.h"
#include "training/beam_search.h"
#include "training/flyer.h"

namespace fresco {
namespace {

constexpr char kOptimalPolicy[] = "optimal";

/// The possible values of --policy, for texts.
constexpr char kPolicyFiles[] = "the folder of a run (with a best.network), a network file or a checkpoint";

constexpr char kBestNetwork[] = "best.network";

std::string Describe(const World& world, const PlannerProgress& progress, double passed_s) {
  return fmt::format(
      "searching for {:.0f} s | slot {} of {} | {} labels of at most {} | average AoI between {:.4f} and "
      "{:.4f}",
      passed_s, progress.slot, world.longest_episode() + 1, progress.labels, progress.width,
      progress.lower_bound_average, progress.best_average);
}

/// `others` are the names of the world's own policies.
[[noreturn]] void RefusePolicy(const std::string& problem, const std::vector<std::string>& others,
                               const std::string& option) {
  const std::string names = others.empty() ? "" : fmt::format("; or {}", fmt::join(others, ", "));
  throw UsageError(fmt::format("{}: expected {}{}; {}", option, kPolicyFiles, names, problem));
}

/// Returns the path of the network file or checkpoint that the policy names.
std::filesystem::path PolicyFile(const std::string& policy, const std::vector<std::string>& others,
                                 const std::string& option) {
  const std::filesystem::path path(policy);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    RefusePolicy(fmt::format("\"{}\" is none of these, and there is no such file{}{}", policy,
                             others.empty() ? "; the world has no policies of its own" : "",
                             DidYouMean(policy, others)),
                 others, option);
  }
  if (!std::filesystem::is_directory(path, error)) {
    return path;
  }
  if (!std::filesystem::exists(path / kBestNetwork, error)) {
    RefusePolicy(
        fmt::format("the folder {} has no {}{}", policy, kBestNetwork, NewestRunHint(path, kBestNetwork)),
        others, option);
  }
  return path / kBestNetwork;
}

/// Returns the network of a network file, or the best one of a checkpoint.
StoredNetwork ReadPolicyFile(const std::filesystem::path& path) {
  const std::string content = ReadFile(path);
  if (!LooksLikeCheckpoint(content)) {
    return ParseNetworkFile(content, path.string());
  }
  const Checkpoint checkpoint = ParseCheckpoint(content, path.string());
  const std::optional<BestNetwork>& best = checkpoint.training.best;
  if (!best) {
    throw UsageError(fmt::format(
        "the checkpoint {} has no network yet: it was taken before the first evaluation", path.string()));
  }
  return {checkpoint.experiment, best->evaluation.version, best->evaluation.updates, *best->parameters};
}

/// The policies of a world that need no file.
std::vector<std::string> BuiltInPolicies(const World& world) {
  std::vector<std::string> names;
  for (const ReferencePolicy& policy : world.reference_policies()) {
    names.push_back(policy.name);
  }
  if (CanPlan(world)) {
    names.push_back(kOptimalPolicy);
  }
  return names;
}

/// `others` are the names of the world's own policies.
StoredNetwork ReadPolicy(const std::string& policy, const std::vector<std::string>& others,
                         const std::string& option) {
  const std::filesystem::path path = PolicyFile(policy, others, option);
  try {
    return ReadPolicyFile(path);
  } catch (const Error& error) {
    RefusePolicy(error.what(), others, option);
  }
}

Experiment GivenExperiment(const PolicyChoice& choice) {
  return Experiment::Load(ExperimentPath(choice.config.empty() ? kDefaultExperiment : choice.config),
                          ParseSettings(choice.settings));
}

/// Returns the experiment to fly in: the world of --config if it is given, otherwise that of the network; the
/// agent is always that of the network. Throws UsageError if the network was not made for that world.
Experiment ExperimentOfNetwork(const PolicyChoice& choice, const StoredNetwork& network) {
  const Settings settings = ParseSettings(choice.settings);
  if (choice.config.empty()) {
    return Experiment::Parse(network.experiment.Text(), choice.policy, settings);
  }
  const Experiment given = GivenExperiment(choice);
  proto::ExperimentConfig config = given.config();
  *config.mutable_agent() = network.experiment.agent();
  Experiment experiment = Experiment::Make(config, choice.config);
  if (experiment.network()->layer_sizes() != network.experiment.network()->layer_sizes()) {
    throw UsageError(fmt::format("{}: its network (inputs, hidden layers, actions) is not that of {}",
                                 choice.config, choice.policy));
  }
  try {
    network.experiment.world().CheckServes(experiment.world());
  } catch (const Error& error) {
    throw UsageError(fmt::format("{}: the policy {} was not trained for such an episode: {}", choice.config,
                                 choice.policy, error.what()));
  }
  return experiment;
}

}  // namespace

void AddPolicyOptions(CLI::App& app, PolicyChoice& choice) {
  app.add_option("--config", choice.config,
                 ConfigHelp(std::string("the one of the trained policy, or ") + kDefaultExperiment))
      ->type_name("EXPERIMENT");
  app.add_option("--set", choice.settings, "Override one field: path=value; may be repeated")
      ->type_name("PATH=VALUE");
  app.add_option(
         "--policy", choice.policy,
         std::string("What acts: ") + kPolicyFiles + "; in the UAV's world also aoi, distance or optimal")
      ->type_name("POLICY")
      ->required();
  app.add_option(
         "--search", choice.search_width,
         "For a trained policy: search for the best episode with the network's values, and keep so many "
         "partial episodes side by side, up to 4096; default: act greedily")
      ->check(CLI::Range(1, 4096));
  app.add_option("--time-limit-s", choice.limits.seconds,
                 "For the policy optimal: stop the search after so many seconds; default: no limit")
      ->check(CLI::Range(0.001, 1e6));
  app.add_option_function<int64_t>(
         "--memory-limit-mb",
         [&choice](int64_t megabytes) { choice.limits.memory_bytes = megabytes * 1'000'000; },
         "For the policy optimal: memory that the search may take; default: 2684")
      ->check(CLI::Range(1, 1'000'000));
  AddArithmeticOption(app);
}

ChosenPolicy ReadChoice(const PolicyChoice& choice) {
  std::error_code error;
  std::vector<std::string> built_in;
  if (!std::filesystem::exists(choice.policy, error)) {  // then it may be the name of one
    Experiment given = GivenExperiment(choice);
    built_in = BuiltInPolicies(given.world());
    if (std::find(built_in.begin(), built_in.end(), choice.policy) != built_in.end()) {
      if (choice.search_width > 0) {
        throw UsageError(fmt::format(
            "--search: expected a trained policy, whose values guide the search; found {}", choice.policy));
      }
      return {std::move(given), std::nullopt};
    }
  }
  StoredNetwork network = ReadPolicy(choice.policy, built_in, "--policy");
  Experiment experiment = ExperimentOfNetwork(choice, network);
  if (choice.search_width > 0 && !experiment.world().description().copies) {
    throw UsageError(
        fmt::format("--search: the world {} can't be searched, since its environments can't be copied",
                    experiment.world().description().name));
  }
  return {std::move(experiment), std::move(network)};
}

StoredNetwork ReadTrainedNetwork(const std::string& policy, const std::string& option) {
  return ReadPolicy(policy, {}, option);
}

Experiment StartFrom(const Experiment& experiment, const std::string& policy, const std::string& option) {
  StoredNetwork network = ReadTrainedNetwork(policy, option);
  const std::vector<int> expected = experiment.network()->layer_sizes();
  const std::vector<int> found = network.experiment.network()->layer_sizes();
  if (expected != found) {
    throw UsageError(fmt::format(
        "{}: expected a network with layers of {} ({}), as this experiment has; found {} in {}", option,
        fmt::join(expected, ", "), experiment.network_field(), fmt::join(found, ", "), policy));
  }
  return experiment.StartingFrom(std::make_shared<const Vector>(std::move(network.parameters)));
}

FlownPolicy FlyPolicy(const PolicyChoice& choice, const ChosenPolicy& chosen, uint64_t seed) {
  if (chosen.network) {
    const auto parameters = std::make_shared<const Vector>(chosen.network->parameters);
    return {chosen.experiment, choice.search_width > 0
                                   ? FlySearching(chosen.experiment, seed, parameters, choice.search_width)
                                   : FlyGreedily(chosen.experiment, seed, parameters)};
  }
  if (choice.policy == kOptimalPolicy) {
    Plan plan = PlanWithin(chosen.experiment.world(), seed, choice.limits);
    return {chosen.experiment, plan.flight, plan};
  }
  return {chosen.experiment, chosen.experiment.world().FlyReference(choice.policy, seed)};
}

std::string FoundFlightName(bool proved) {
  return proved ? "exact optimum" : "best flight of the search";
}

std::string EpisodeName(const FlownPolicy& flown, const std::string& policy) {
  return flown.plan && !flown.plan->optimal ? FoundFlightName(false) : policy;
}

std::string EpisodeSummary(const FlownPolicy& flown, const std::string& policy) {
  return EpisodeName(flown, policy) + ": " + flown.world().Tell(flown.episode).sentence;
}

Plan PlanWithin(const World& world, uint64_t seed, const PlannerLimits& limits) {
  constexpr double kSilentS = 1;  // show no progress before; most searches end earlier
  const int64_t begin_us = MonotonicMicroseconds();
  LiveLine line(limits.show_progress);
  PlannerOptions options;
  options.memory_bytes = limits.memory_bytes;
  options.keep_going = [&](const PlannerProgress& progress) {
    const double passed_s = static_cast<double>(MonotonicMicroseconds() - begin_us) * 1e-6;
    if (passed_s > kSilentS) {
      line.Show(Describe(world, progress, passed_s));
    }
    return !StopSignal::Requested() && (limits.seconds <= 0 || passed_s < limits.seconds);
  };
  return PlanOptimally(world, seed, options);
}

}  // namespace fresco
