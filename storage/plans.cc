#include "storage/plans.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Throws if a value is missing or of another type, or if the actions are no episode of this world.
std::shared_ptr<const Plan> PlanFrom(const World& world, uint64_t seed, const OrderedJson& json) {
  auto plan = std::make_shared<Plan>();
  plan->optimal = json.at("optimal");
  plan->lower_bound_average_aoi = json.at("lower_bound_average_aoi");
  plan->lower_bound_total_aoi = json.at("lower_bound_total_aoi");
  plan->labels = json.at("labels");
  const auto actions = json.at("actions").get<std::vector<int16_t>>();
  if (!FlyActions(world, seed, actions, plan->flight)) {
    throw Failure(fmt::format("the actions of episode {} are no episode of this run's world", seed));
  }
  return plan;
}

}  // namespace

std::string OptimumJson(const World& world, std::span<const uint64_t> seeds,
                        std::span<const std::shared_ptr<const Plan>> plans) {
  OrderedJson json = {{"episodes", OrderedJson::array()}};
  for (size_t i = 0; i < plans.size(); ++i) {
    if (plans[i] == nullptr) {
      continue;
    }
    const Plan& plan = *plans[i];
    std::vector<double> figures(world.description().figures.size());
    world.Judge(plan.flight, figures);
    OrderedJson episode = {{"seed", seeds[i]}, {"optimal", plan.optimal}};
    for (size_t figure = 0; figure < figures.size(); ++figure) {
      episode[world.description().figures[figure].name] = figures[figure];
    }
    episode["lower_bound_total_aoi"] = plan.lower_bound_total_aoi;
    episode["lower_bound_average_aoi"] = plan.lower_bound_average_aoi;
    episode["labels"] = plan.labels;
    episode["actions"] = plan.flight.actions;
    json["episodes"].push_back(std::move(episode));
  }
  return json.dump();
}

std::vector<std::shared_ptr<const Plan>> PlansIn(const std::filesystem::path& folder, const World& world,
                                                 std::span<const uint64_t> seeds) {
  std::vector<std::shared_ptr<const Plan>> plans(seeds.size());
  const std::filesystem::path file = folder / kOptimumFile;
  if (!std::filesystem::exists(file)) {
    return plans;
  }
  try {
    const OrderedJson json = OrderedJson::parse(ReadFile(file));
    std::map<uint64_t, const OrderedJson*> by_seed;
    for (const OrderedJson& episode : json.at("episodes")) {
      by_seed[episode.at("seed").get<uint64_t>()] = &episode;
    }
    for (size_t i = 0; i < seeds.size(); ++i) {
      if (const auto found = by_seed.find(seeds[i]); found != by_seed.end()) {
        plans[i] = PlanFrom(world, seeds[i], *found->second);
      }
    }
  } catch (const std::exception& error) {
    spdlog::warn("{} can't be used: {}", file.string(), error.what());
    plans.assign(seeds.size(), nullptr);
  }
  return plans;
}

}  // namespace fresco
