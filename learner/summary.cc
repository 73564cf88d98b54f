#include "learner/summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/crc32c.h"
#include "core/version.h"

namespace fresco {
namespace {

using Json = nlohmann::ordered_json;

Json BaselineFigures(const World& world, BaselineKind kind) {
  const Flight flight = FlyBaseline(world, kind);
  const AoiFigures figures = Figures(world, flight);
  return {{"total_aoi", figures.total_aoi},
          {"average_aoi", figures.average_aoi},
          {"sum_aoi", figures.sum_aoi},
          {"arrived", flight.arrived()}};
}

Json Counters(const BusCounters& counters) {
  return {{"received", counters.received},
          {"lost", counters.lost},
          {"duplicate", counters.duplicate},
          {"rejected", counters.rejected},
          {"rejected_malformed", counters.rejected_malformed},
          {"rejected_foreign", counters.rejected_foreign},
          {"rejected_inconsistent", counters.rejected_inconsistent},
          {"rejected_arithmetic", counters.rejected_arithmetic},
          {"reordered_episodes", counters.reordered_episodes},
          {"stale_statuses", counters.stale_statuses},
          {"crowded_statuses", counters.crowded_statuses},
          {"weights_chunks_sent", counters.weights_chunks_sent},
          {"weights_chunks_repeated", counters.weights_chunks_repeated}};
}

void AddPolicy(const std::optional<BestNetwork>& best, Json& json) {
  const auto value = [&](auto figure) { return best ? Json(figure(best->evaluation)) : Json(); };
  json["total_aoi"] = value([](const Evaluation& e) { return e.figures.total_aoi; });
  json["average_aoi"] = value([](const Evaluation& e) { return e.figures.average_aoi; });
  json["sum_aoi"] = value([](const Evaluation& e) { return e.figures.sum_aoi; });
  json["arrived"] = value([](const Evaluation& e) { return e.arrived; });
  json["best_version"] = value([](const Evaluation& e) { return e.version; });
}

void AddOptimum(const SummaryInputs& inputs, Json& json) {
  const Plan* plan = inputs.plan.get();
  const std::optional<BestNetwork>& best = inputs.trainer.best();
  const bool optimal = plan != nullptr && plan->optimal;
  const AoiFigures figures = optimal ? Figures(inputs.world, plan->flight) : AoiFigures{};
  json["optimal_total_aoi"] = optimal ? Json(figures.total_aoi) : Json();
  json["optimal_average_aoi"] = optimal ? Json(figures.average_aoi) : Json();
  json["lower_bound_average_aoi"] = plan != nullptr ? Json(plan->lower_bound_average_aoi) : Json();
  json["gap_percent"] =
      plan != nullptr && best && best->evaluation.arrived
          ? Json(GapPercent(best->evaluation.figures.average_aoi, plan->lower_bound_average_aoi))
          : Json();
}

}  // namespace

std::string OptimumJson(const World& world, const Plan& plan) {
  const AoiFigures figures = Figures(world, plan.flight);
  Json json = {{"optimal", plan.optimal},
               {"total_aoi", figures.total_aoi},
               {"average_aoi", figures.average_aoi},
               {"lower_bound_total_aoi", plan.lower_bound_total_aoi},
               {"lower_bound_average_aoi", plan.lower_bound_average_aoi},
               {"labels", plan.labels}};
  Json& actions = json["actions"] = Json::array();
  for (size_t slot = 0; slot + 1 < plan.flight.slots.size(); ++slot) {
    actions.push_back(world.ActionIndex(plan.flight.slots[slot].action));
  }
  return json.dump();
}

std::string SummaryJson(const SummaryInputs& inputs) {
  const TrainerProgress& progress = inputs.trainer.progress();
  const Vector& weights = inputs.trainer.current();
  const std::span<const float> values(weights.data(), static_cast<size_t>(weights.size()));
  Json json;
  json["run_id"] = fmt::format("{:016x}", static_cast<uint64_t>(inputs.run_id));
  json["config_hash"] = fmt::format("{:08x}", inputs.experiment.hash());
  json["seed"] = inputs.experiment.schedule().seed();
  json["completed"] = inputs.completed;
  json["episodes"] = progress.episodes;
  json["transitions"] = progress.transitions;
  json["updates"] = progress.updates;
  json["wall_s"] = inputs.wall_s;
  json["updates_per_s"] = static_cast<double>(progress.updates) / inputs.wall_s;
  json["transitions_per_s"] = static_cast<double>(progress.transitions) / inputs.wall_s;
  json["weights_crc32c"] = fmt::format("{:08x}", Crc32c(values));
  AddPolicy(inputs.trainer.best(), json);
  AddOptimum(inputs, json);
  json["baselines"] = {{"aoi", BaselineFigures(inputs.world, BaselineKind::kAoi)},
                       {"distance", BaselineFigures(inputs.world, BaselineKind::kDistance)}};
  json["staleness_updates"] = progress.staleness_updates;
  json["bus"] = Counters(inputs.counters);
  json["software_version"] = kSoftwareVersion;
  return json.dump(2);
}

}  // namespace fresco
