#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/signals.h"
#include "report/result_display.h"
#include "storage/policy.h"
#include "tools/subcommands.h"
#include "training/schedules.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct EvaluateOptions {
  PolicyChoice choice;
  std::optional<int> episodes;
  std::optional<uint64_t> seed;
  std::string format = "text";
};

void PrintProof(const Plan& plan) {
  if (plan.optimal) {
    fmt::print("This is the exact optimum: no flight has a smaller average AoI.\n");
  } else {
    const double average_aoi = plan.lower_bound_average_aoi;
    fmt::print(
        "The search was stopped early: no flight has an average AoI below {:.3f} (total AoI {:.1f}).\n",
        average_aoi, plan.lower_bound_total_aoi);
  }
}

/// The figures of several episodes.
struct EpisodeFigures {
  std::vector<uint64_t> seeds;
  std::vector<std::vector<double>> figures;  // by episode
  std::vector<bool> succeeded;               // by episode
};

EpisodeFigures FlyEpisodes(const EvaluateOptions& options, const ChosenPolicy& chosen) {
  const World& world = chosen.experiment.world();
  const proto::Schedule& schedule = chosen.experiment.schedule();
  EpisodeFigures result;
  for (int i = 0; i < options.episodes.value_or(schedule.evaluation_episodes()) && !StopSignal::Requested();
       ++i) {
    result.seeds.push_back(EvaluationSeed(options.seed.value_or(schedule.seed()), i));
    const FlownPolicy flown = FlyPolicy(options.choice, chosen, result.seeds.back());
    result.figures.emplace_back(world.description().figures.size());
    world.Judge(flown.episode, result.figures.back());
    result.succeeded.push_back(world.Succeeded(flown.episode));
  }
  return result;
}

double Mean(const EpisodeFigures& episodes, size_t figure) {
  double sum = 0;
  for (const std::vector<double>& figures : episodes.figures) {
    sum += figures[figure];
  }
  return sum / static_cast<double>(episodes.figures.size());
}

double SuccessShare(const EpisodeFigures& episodes) {
  const auto successes = std::count(episodes.succeeded.begin(), episodes.succeeded.end(), true);
  return static_cast<double>(successes) / static_cast<double>(episodes.succeeded.size());
}

void PrintEpisodes(const WorldDescription& world, const EpisodeFigures& episodes, const std::string& policy) {
  for (size_t figure = 0; figure < world.figures.size(); ++figure) {
    const auto [least, most] =
        std::minmax_element(episodes.figures.begin(), episodes.figures.end(),
                            [&](const auto& a, const auto& b) { return a[figure] < b[figure]; });
    fmt::print("{}: {} {:.3f}{} on average over {} episodes, {:.3f} to {:.3f}\n", policy,
               Title(world.figures[figure].name), Mean(episodes, figure),
               world.figures[figure].unit.empty() ? "" : " " + world.figures[figure].unit,
               episodes.figures.size(), (*least)[figure], (*most)[figure]);
  }
  fmt::print("{}: {} {}\n", policy, PercentText(SuccessShare(episodes)), Title(world.success));
}

std::string EpisodesJson(const WorldDescription& world, const EpisodeFigures& episodes,
                         const std::string& policy) {
  OrderedJson json = {{"policy", policy},
                      {"world", world.name},
                      {"score", Mean(episodes, 0)},
                      {"success", SuccessShare(episodes)}};
  for (size_t figure = 0; figure < world.figures.size(); ++figure) {
    json[world.figures[figure].name] = Mean(episodes, figure);
  }
  json["episodes"] = OrderedJson::array();
  for (size_t i = 0; i < episodes.figures.size(); ++i) {
    OrderedJson episode = {{"seed", episodes.seeds[i]}, {world.success, bool{episodes.succeeded[i]}}};
    for (size_t figure = 0; figure < world.figures.size(); ++figure) {
      episode[world.figures[figure].name] = episodes.figures[i][figure];
    }
    json["episodes"].push_back(std::move(episode));
  }
  return json.dump(2);
}

/// Without chance, a single episode tells everything about a policy.
int EvaluateOnce(const EvaluateOptions& options, const ChosenPolicy& chosen) {
  const std::string& policy = options.choice.policy;
  const FlownPolicy flown = FlyPolicy(options.choice, chosen);
  const EpisodeAccount account = flown.world().Tell(flown.episode);
  if (options.format == "json") {
    fmt::print("{}\n", EpisodeJson(account, policy, flown.plan));
  } else {
    fmt::print("{}\n{}\n", StepTable(account), EpisodeSummary(flown, policy));
    if (flown.plan) {
      PrintProof(*flown.plan);
    }
  }
  return StopSignal::Requested() ? 1 : 0;
}

int Evaluate(const EvaluateOptions& options) {
  const ChosenPolicy chosen = ReadChoice(options.choice);
  const World& world = chosen.experiment.world();
  if (!world.description().random) {
    return EvaluateOnce(options, chosen);
  }
  const EpisodeFigures episodes = FlyEpisodes(options, chosen);
  if (StopSignal::Requested()) {
    return 1;
  }
  if (options.format == "json") {
    fmt::print("{}\n", EpisodesJson(world.description(), episodes, options.choice.policy));
  } else {
    PrintEpisodes(world.description(), episodes, options.choice.policy);
  }
  return 0;
}

}  // namespace

void AddEvaluate(CLI::App& app, Command& command) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* evaluate = app.add_subcommand(
      "evaluate",
      "Act greedily: show an episode step by step or, in worlds with chance, the figures of several");
  AddPolicyOptions(*evaluate, options->choice);
  evaluate
      ->add_option("--episodes", options->episodes,
                   "Episodes, in worlds with chance; default: schedule.evaluation_episodes")
      ->check(CLI::Range(1, 1'000'000));
  evaluate->add_option("--seed", options->seed, "Seed of these episodes; default: schedule.seed");
  evaluate->add_option("--format", options->format, "text or json")->check(OneOf({"text", "json"}));
  options->choice.limits.show_progress = true;
  evaluate->callback([options, &command] { command = [options] { return Evaluate(*options); }; });
}

}  // namespace fresco
