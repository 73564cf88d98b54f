#include "storage/summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/bytes.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "storage/judgement.h"
#include "training/schedules.h"

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

/// The mean of what the planner proved of the episodes of fixed evaluations, which the learning curve shows;
/// null if it is not proved for each of them.
OrderedJson OptimumOfEvaluations(const SummaryInputs& inputs) {
  const auto count = static_cast<size_t>(inputs.experiment.schedule().evaluation_episodes());
  double sum = 0;
  for (size_t i = 0; i < count; ++i) {
    const Plan* plan = i < inputs.optimum.plans.size() ? inputs.optimum.plans[i].get() : nullptr;
    if (plan == nullptr || !plan->optimal) {
      return {};
    }
    sum += plan->lower_bound_average_aoi;
  }
  return sum / static_cast<double>(count);
}

/// What is known of the policy beside others, in the episodes by which it is judged.
OrderedJson JudgementOf(const SummaryInputs& inputs) {
  const proto::Schedule& schedule = inputs.experiment.schedule();
  const World& world = inputs.experiment.world();
  const bool fixed = schedule.fixed_evaluation_episodes() && world.description().random;
  const bool delivered = inputs.trainer.delivered().has_value();
  std::vector<uint64_t> seeds =
      fixed && delivered ? FixedDeliverySeeds(schedule) : FixedEvaluationSeeds(schedule);
  std::span<const std::shared_ptr<const Plan>> plans = inputs.optimum.plans;
  if (!world.description().random) {
    seeds = {0};
  } else {  // those of EpisodesToPlan: first of the fixed evaluations, then of the delivery
    plans = plans.size() == 2 * seeds.size() ? plans.subspan(delivered ? seeds.size() : 0, seeds.size())
                                             : plans.first(0);
  }
  return OrderedJson::parse(JudgementJson({world, seeds, JudgedBy(inputs.trainer), plans}));
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
  json.update(JudgementOf(inputs));
  json["best_version"] =
      inputs.trainer.best() ? OrderedJson(inputs.trainer.best()->evaluation.version) : OrderedJson();
  json["evaluation_episodes"] = inputs.experiment.schedule().evaluation_episodes();
  if (CanPlan(world)) {
    json["optimum_search"] = SearchEndName(inputs.optimum.end);
  }
  if (json.contains("judged_episodes")) {
    json["evaluations_optimal_" + world.description().figures.front().name] = OptimumOfEvaluations(inputs);
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
