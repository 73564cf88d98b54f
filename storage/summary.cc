#include "storage/summary.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/bytes.h"
#include "core/identifier.h"
#include "core/installation.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// A counter and its name.
struct BusCounterField {
  const char* name;
  int64_t BusCounters::*value;
};
/// Every counter, in the order of the struct.
constexpr BusCounterField kBusCounterFields[] = {
    {"received", &BusCounters::received},
    {"lost", &BusCounters::lost},
    {"duplicate", &BusCounters::duplicate},
    {"rejected", &BusCounters::rejected},
    {"rejected_malformed", &BusCounters::rejected_malformed},
    {"rejected_foreign", &BusCounters::rejected_foreign},
    {"rejected_inconsistent", &BusCounters::rejected_inconsistent},
    {"rejected_arithmetic", &BusCounters::rejected_arithmetic},
    {"rejected_unauthenticated", &BusCounters::rejected_unauthenticated},
    {"reordered_episodes", &BusCounters::reordered_episodes},
    {"stale_statuses", &BusCounters::stale_statuses},
    {"crowded_statuses", &BusCounters::crowded_statuses},
    {"weights_chunks_sent", &BusCounters::weights_chunks_sent},
    {"weights_chunks_repeated", &BusCounters::weights_chunks_repeated},
};

/// The number, as a whole one if it is.
OrderedJson Number(double value) {
  constexpr double kLargestWhole = 1e15;
  const bool whole = std::abs(value) < kLargestWhole && value == std::trunc(value);
  return whole ? OrderedJson(static_cast<int64_t>(value)) : OrderedJson(value);
}

std::vector<double> FiguresOf(const World& world, const Episode& episode) {
  std::vector<double> figures(world.description().figures.size());
  world.Judge(episode, figures);
  return figures;
}

/// Adds each figure under its name with the prefix; null without figures.
void AddFigures(const World& world, const std::string& prefix, const std::vector<double>* figures,
                OrderedJson& json) {
  for (size_t i = 0; i < world.description().figures.size(); ++i) {
    json[prefix + world.description().figures[i].name] =
        figures == nullptr ? OrderedJson() : Number((*figures)[i]);
  }
}

OrderedJson WorldJson(const WorldDescription& description) {
  OrderedJson json = {{"name", description.name}, {"success", description.success}};
  for (const Quantity& figure : description.figures) {
    json["figures"].push_back({{"name", figure.name}, {"unit", figure.unit}});
  }
  return json;
}

OrderedJson Baselines(const World& world) {
  OrderedJson json = OrderedJson::object();
  for (const ReferencePolicy& policy : world.reference_policies()) {
    const Episode episode = world.FlyReference(policy.name);
    const std::vector<double> figures = FiguresOf(world, episode);
    OrderedJson& baseline = json[policy.name] = {{"title", policy.title}};
    AddFigures(world, "", &figures, baseline);
    baseline[world.description().success] = world.Succeeded(episode);
  }
  return json;
}

OrderedJson Counters(const BusCounters& counters) {
  OrderedJson json;
  for (const BusCounterField& field : kBusCounterFields) {
    json[field.name] = counters.*field.value;
  }
  return json;
}

double Seconds(int64_t microseconds) {
  return 1e-6 * static_cast<double>(microseconds);
}

OrderedJson Updating(const std::optional<UpdatingFigures>& updating) {
  return !updating ? OrderedJson()
                   : OrderedJson({{"wall_s", Seconds(updating->wall_us)},
                                  {"updates", updating->updates},
                                  {"training_thread_s", Seconds(updating->training_thread_us)},
                                  {"learner_s", Seconds(updating->learner_us)}});
}

OrderedJson ProcessorTimes(const SummaryInputs& inputs) {
  const std::optional<ProcessorFigures>& processor = inputs.processor;
  return !processor ? OrderedJson()
                    : OrderedJson({{"learner", Seconds(processor->learner_us)},
                                   {"training_thread", Seconds(processor->training_thread_us)},
                                   {"optimum_search", inputs.optimum.processor_seconds},
                                   {"actors", Seconds(processor->actors_us)}});
}

/// The evaluation that the run is judged by.
const Evaluation* JudgedBy(const Trainer& trainer) {
  if (trainer.delivered()) {
    return &*trainer.delivered();
  }
  return trainer.best() ? &trainer.best()->evaluation : nullptr;
}

void AddPolicy(const World& world, const Evaluation* evaluation, OrderedJson& json) {
  const auto value = [&](auto figure) {
    return evaluation ? OrderedJson(figure(*evaluation)) : OrderedJson();
  };
  json["score"] = value([](const Evaluation& e) { return Number(e.score()); });
  json["success"] = value([](const Evaluation& e) { return Number(e.success); });
  AddFigures(world, "", evaluation ? &evaluation->figures : nullptr, json);
  json[world.description().success] = value([](const Evaluation& e) { return e.success == 1; });
}

void AddOptimum(const SummaryInputs& inputs, OrderedJson& json) {
  const World& world = inputs.experiment.world();
  const std::string& score = world.description().figures.front().name;
  const Plan* plan = inputs.optimum.plan.get();
  const Evaluation* evaluation = JudgedBy(inputs.trainer);
  const bool proved = plan != nullptr && plan->optimal;
  const std::vector<double> found = plan == nullptr ? std::vector<double>() : FiguresOf(world, plan->flight);
  json["optimum_search"] = SearchEndName(inputs.optimum.end);
  AddFigures(world, "optimal_", proved ? &found : nullptr, json);
  AddFigures(world, "best_found_", plan != nullptr ? &found : nullptr, json);
  json["lower_bound_" + score] = plan != nullptr ? Number(plan->lower_bound_average_aoi) : OrderedJson();
  const bool has_gap = proved && evaluation != nullptr && evaluation->success == 1;
  json["gap_percent"] =
      has_gap ? OrderedJson(GapPercent(evaluation->score(), plan->lower_bound_average_aoi)) : OrderedJson();
}

}  // namespace

std::map<std::string, int64_t> ToMap(const BusCounters& counters) {
  std::map<std::string, int64_t> map;
  for (const BusCounterField& field : kBusCounterFields) {
    map[field.name] = counters.*field.value;
  }
  return map;
}

BusCounters FromMap(const std::map<std::string, int64_t>& map) {
  BusCounters counters;
  for (const BusCounterField& field : kBusCounterFields) {
    const auto found = map.find(field.name);
    counters.*field.value = found == map.end() ? 0 : found->second;
  }
  return counters;
}

bool IsFinished(const std::string& summary_json) {
  const auto summary = nlohmann::json::parse(summary_json, nullptr, false);
  return summary.is_object() && summary.value("completed", false) &&
         summary.value("optimum_search", SearchEndName(SearchEnd::kOff)) !=
             SearchEndName(SearchEnd::kStopped);
}

std::string OptimumJson(const World& world, const Plan& plan) {
  const std::vector<double> figures = FiguresOf(world, plan.flight);
  OrderedJson json = {{"optimal", plan.optimal}};
  AddFigures(world, "", &figures, json);
  json["lower_bound_total_aoi"] = plan.lower_bound_total_aoi;
  json["lower_bound_average_aoi"] = plan.lower_bound_average_aoi;
  json["labels"] = plan.labels;
  json["actions"] = plan.flight.actions;
  return json.dump();
}

std::string SummaryJson(const SummaryInputs& inputs) {
  const TrainerProgress& progress = inputs.trainer.progress();
  const World& world = inputs.experiment.world();
  OrderedJson json;
  json["run_id"] = IdentifierText(inputs.run_id);
  json["config_hash"] = fmt::format("{:08x}", inputs.experiment.hash());
  json["seed"] = inputs.experiment.schedule().seed();
  json["completed"] = inputs.completed;
  json["episodes"] = progress.episodes;
  json["transitions"] = progress.transitions;
  json["updates"] = progress.updates;
  json["wall_s"] = inputs.wall_s;
  json["updates_per_s"] = static_cast<double>(progress.updates) / inputs.wall_s;
  json["transitions_per_s"] = static_cast<double>(progress.transitions) / inputs.wall_s;
  json["weights_crc32c"] = fmt::format("{:08x}", Crc32c(Values(inputs.trainer.current())));
  json["world"] = WorldJson(world.description());
  AddPolicy(world, JudgedBy(inputs.trainer), json);
  json["best_version"] =
      inputs.trainer.best() ? OrderedJson(inputs.trainer.best()->evaluation.version) : OrderedJson();
  json["evaluation_episodes"] = inputs.experiment.schedule().evaluation_episodes();
  if (CanPlan(world)) {
    AddOptimum(inputs, json);
  }
  if (!world.reference_policies().empty()) {
    json["baselines"] = Baselines(world);
  }
  json["staleness_updates"] = progress.staleness_updates;
  json["bus"] = Counters(inputs.counters);
  json["resumptions"] = inputs.resumptions;
  json["checkpoints"] = {
      {"taken", inputs.checkpoints.taken},
      {"longest_pause_ms", 1e-3 * static_cast<double>(inputs.checkpoints.longest_pause_us)}};
  json["updating"] = Updating(inputs.updating);
  json["processor_s"] = ProcessorTimes(inputs);
  json["software_version"] = kSoftwareVersion;
  return json.dump(2);
}

}  // namespace fresco
