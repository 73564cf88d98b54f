#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "core/clock.h"
#include "core/help_formatter.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "report/result_display.h"
#include "storage/judgement.h"
#include "storage/plans.h"
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

/// Episodes of one policy.
struct FlownEpisodes {
  std::vector<uint64_t> seeds;
  PolicyFigures figures;
  std::vector<std::shared_ptr<const Plan>> plans;  // by episode; null where there is none
  int64_t steps = 0;
  double seconds = 0;  // that the policy took

  bool has_plan() const {
    return std::any_of(plans.begin(), plans.end(), [](const auto& plan) { return plan != nullptr; });
  }
};

/// The seeds of the episodes to fly. If evaluations fly fixed episodes, they are those of the delivery.
std::vector<uint64_t> SeedsToFly(const EvaluateOptions& options, const proto::Schedule& schedule) {
  const int64_t first = schedule.fixed_evaluation_episodes() ? schedule.evaluation_episodes() : 0;
  std::vector<uint64_t> seeds;
  for (int i = 0; i < options.episodes.value_or(schedule.evaluation_episodes()); ++i) {
    seeds.push_back(EvaluationSeed(options.seed.value_or(schedule.seed()), first + i));
  }
  return seeds;
}

/// The plans that the run of the policy has of these episodes, if it is a run in the same world.
std::vector<std::shared_ptr<const Plan>> PlansOfRun(const PolicyChoice& choice, const ChosenPolicy& chosen,
                                                    const std::vector<uint64_t>& seeds) {
  const bool same_world =
      chosen.network && chosen.network->experiment.WorldText() == chosen.experiment.WorldText();
  return same_world ? PlansIn(choice.policy, chosen.experiment.world(), seeds)
                    : std::vector<std::shared_ptr<const Plan>>(seeds.size());
}

FlownEpisodes FlyEpisodes(const EvaluateOptions& options, const ChosenPolicy& chosen) {
  const World& world = chosen.experiment.world();
  FlownEpisodes episodes;
  episodes.seeds = SeedsToFly(options, chosen.experiment.schedule());
  episodes.plans = PlansOfRun(options.choice, chosen, episodes.seeds);
  LiveLine line(episodes.seeds.size() > 1);
  TimeLeft time_left;
  for (size_t i = 0; i < episodes.seeds.size() && !StopSignal::Requested(); ++i) {
    const int64_t begin_us = MonotonicMicroseconds();
    const std::string left =
        time_left.Report(static_cast<double>(i), static_cast<double>(episodes.seeds.size()), begin_us);
    if (!left.empty()) {
      line.Show(fmt::format("{} of {} episodes | {}", i, episodes.seeds.size(), left));
    }
    const FlownPolicy flown = FlyPolicy(options.choice, chosen, episodes.seeds[i]);
    episodes.seconds += 1e-6 * static_cast<double>(MonotonicMicroseconds() - begin_us);
    episodes.steps += flown.episode.transitions();
    episodes.figures.Add(world, flown.episode);
    if (flown.plan) {
      episodes.plans[i] = std::make_shared<const Plan>(*flown.plan);
    }
  }
  return episodes;
}

/// JudgementJson of the policy in these episodes.
std::string Judge(const World& world, const FlownEpisodes& episodes) {
  const Evaluation policy{
      0, 0, 0, episodes.figures.success(), episodes.figures.Means(), episodes.figures.scores()};
  return JudgementJson(
      {world, episodes.seeds, &policy,
       episodes.has_plan() ? std::span(episodes.plans) : std::span<const std::shared_ptr<const Plan>>()});
}

double DecisionMilliseconds(const FlownEpisodes& episodes) {
  return 1e3 * episodes.seconds / static_cast<double>(episodes.steps);
}

void PrintEpisodes(const WorldDescription& world, const FlownEpisodes& episodes, const std::string& policy) {
  const std::vector<std::vector<double>>& figures = episodes.figures.figures();
  const std::vector<double> means = episodes.figures.Means();
  for (size_t figure = 0; figure < world.figures.size(); ++figure) {
    const auto [least, most] = std::minmax_element(
        figures.begin(), figures.end(), [&](const auto& a, const auto& b) { return a[figure] < b[figure]; });
    fmt::print("{}: {} {:.3f}{} on average over {} episodes, {:.3f} to {:.3f}\n", policy,
               Title(world.figures[figure].name), means[figure],
               world.figures[figure].unit.empty() ? "" : " " + world.figures[figure].unit, figures.size(),
               (*least)[figure], (*most)[figure]);
  }
  fmt::print("{}: {} {}\n", policy, PercentText(episodes.figures.success()), Title(world.success));
}

/// The judgement, with the figures of every episode in `episodes`.
std::string EpisodesJson(const WorldDescription& world, const FlownEpisodes& episodes,
                         const EvaluateOptions& options, const std::string& judgement) {
  const OrderedJson judged = OrderedJson::parse(judgement);
  OrderedJson json = {{"policy", options.choice.policy}};
  json.update(judged);
  json["world"] = world.name;
  json.erase("judged_episodes");
  if (options.choice.search_width > 0) {
    json["search_width"] = options.choice.search_width;
    json["decision_ms"] = DecisionMilliseconds(episodes);
  }
  json["episodes"] = OrderedJson::array();
  for (size_t i = 0; i < episodes.seeds.size(); ++i) {
    OrderedJson episode = {{"seed", episodes.seeds[i]},
                           {world.success, bool{episodes.figures.succeeded()[i]}}};
    for (size_t figure = 0; figure < world.figures.size(); ++figure) {
      episode[world.figures[figure].name] = episodes.figures.figures()[i][figure];
    }
    if (judged.contains("judged_episodes")) {
      episode.update(judged.at("judged_episodes").at(i));
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
  const FlownEpisodes episodes = FlyEpisodes(options, chosen);
  if (StopSignal::Requested()) {
    return 1;
  }
  const std::string judgement = Judge(world, episodes);
  if (options.format == "json") {
    fmt::print("{}\n", EpisodesJson(world.description(), episodes, options, judgement));
    return 0;
  }
  PrintEpisodes(world.description(), episodes, options.choice.policy);
  if (options.choice.search_width > 0) {
    fmt::print("{}: {:.3f} ms a decision\n", options.choice.policy, DecisionMilliseconds(episodes));
  }
  if (!world.reference_policies().empty()) {
    fmt::print("\n{}", ResultTable(judgement, options.choice.policy));
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
  evaluate->add_option("--format", options->format, "How the result is printed")
      ->check(OneOf({"text", "json"}));
  options->choice.limits.show_progress = true;
  evaluate->footer(
      HelpExamples({"fresco evaluate --policy runs/NAME", "fresco evaluate --policy runs/NAME --search 64",
                    "fresco evaluate --policy optimal --config tight_energy",
                    "fresco evaluate --policy runs/NAME --format json"}));
  evaluate->callback([options, &command] { command = [options] { return Evaluate(*options); }; });
}

}  // namespace fresco
