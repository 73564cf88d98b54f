#include "storage/summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/bytes.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "worlds/uav/baselines.h"

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

OrderedJson BaselineFigures(const World& world, BaselineKind kind) {
  const Episode flight = FlyBaseline(world, kind);
  const AoiFigures figures = Figures(world, flight);
  return {{"total_aoi", figures.total_aoi},
          {"average_aoi", figures.average_aoi},
          {"sum_aoi", figures.sum_aoi},
          {"arrived", flight.arrived()}};
}

OrderedJson Counters(const BusCounters& counters) {
  OrderedJson json;
  for (const BusCounterField& field : kBusCounterFields) {
    json[field.name] = counters.*field.value;
  }
  return json;
}

void AddPolicy(const std::optional<BestNetwork>& best, OrderedJson& json) {
  const auto value = [&](auto figure) {
    return best ? OrderedJson(figure(best->evaluation)) : OrderedJson();
  };
  json["total_aoi"] = value([](const Evaluation& e) { return e.figures.total_aoi; });
  json["average_aoi"] = value([](const Evaluation& e) { return e.figures.average_aoi; });
  json["sum_aoi"] = value([](const Evaluation& e) { return e.figures.sum_aoi; });
  json["arrived"] = value([](const Evaluation& e) { return e.arrived; });
  json["best_version"] = value([](const Evaluation& e) { return e.version; });
}

void AddOptimum(const SummaryInputs& inputs, OrderedJson& json) {
  const Plan* plan = inputs.optimum.plan.get();
  const std::optional<BestNetwork>& best = inputs.trainer.best();
  const bool found = plan != nullptr;
  const bool proved = found && plan->optimal;
  const AoiFigures figures = found ? Figures(inputs.world, plan->flight) : AoiFigures{};
  const double lower_bound = found ? plan->lower_bound_average_aoi : 0;
  const auto value_if = [](bool known, auto value) { return known ? OrderedJson(value) : OrderedJson(); };
  json["optimum_search"] = SearchEndName(inputs.optimum.end);
  json["optimal_total_aoi"] = value_if(proved, figures.total_aoi);
  json["optimal_average_aoi"] = value_if(proved, figures.average_aoi);
  json["best_found_total_aoi"] = value_if(found, figures.total_aoi);
  json["best_found_average_aoi"] = value_if(found, figures.average_aoi);
  json["lower_bound_average_aoi"] = value_if(found, lower_bound);
  const bool has_gap = proved && best && best->evaluation.arrived;
  json["gap_percent"] =
      has_gap ? OrderedJson(GapPercent(best->evaluation.figures.average_aoi, lower_bound)) : OrderedJson();
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
         summary.value("optimum_search", "") != SearchEndName(SearchEnd::kStopped);
}

std::string OptimumJson(const World& world, const Plan& plan) {
  const AoiFigures figures = Figures(world, plan.flight);
  OrderedJson json = {{"optimal", plan.optimal},
                      {"total_aoi", figures.total_aoi},
                      {"average_aoi", figures.average_aoi},
                      {"lower_bound_total_aoi", plan.lower_bound_total_aoi},
                      {"lower_bound_average_aoi", plan.lower_bound_average_aoi},
                      {"labels", plan.labels}};
  json["actions"] = plan.flight.actions;
  return json.dump();
}

std::string SummaryJson(const SummaryInputs& inputs) {
  const TrainerProgress& progress = inputs.trainer.progress();
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
  AddPolicy(inputs.trainer.best(), json);
  AddOptimum(inputs, json);
  json["baselines"] = {{"aoi", BaselineFigures(inputs.world, BaselineKind::kAoi)},
                       {"distance", BaselineFigures(inputs.world, BaselineKind::kDistance)}};
  json["staleness_updates"] = progress.staleness_updates;
  json["bus"] = Counters(inputs.counters);
  json["resumptions"] = inputs.resumptions;
  json["checkpoints"] = {
      {"taken", inputs.checkpoints.taken},
      {"longest_pause_ms", 1e-3 * static_cast<double>(inputs.checkpoints.longest_pause_us)}};
  json["software_version"] = kSoftwareVersion;
  return json.dump(2);
}

}  // namespace fresco
