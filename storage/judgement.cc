#include "storage/judgement.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "storage/optimum_search.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// The number, as a whole one if it is.
OrderedJson NumberJson(double value) {
  constexpr double kLargestWhole = 1e15;
  const bool whole = std::abs(value) < kLargestWhole && value == std::trunc(value);
  return whole ? OrderedJson(static_cast<int64_t>(value)) : OrderedJson(value);
}

/// Adds each figure under its name with the prefix; null without figures.
void AddFigures(const World& world, const std::string& prefix, const std::vector<double>* figures,
                OrderedJson& json) {
  for (size_t i = 0; i < world.description().figures.size(); ++i) {
    json[prefix + world.description().figures[i].name] =
        figures == nullptr ? OrderedJson() : NumberJson((*figures)[i]);
  }
}

OrderedJson WorldJson(const WorldDescription& description) {
  OrderedJson json = {{"name", description.name}, {"success", description.success}};
  for (const Quantity& figure : description.figures) {
    json["figures"].push_back({{"name", figure.name}, {"unit", figure.unit}});
  }
  return json;
}

/// Makes the JSON object.
class Judgement {
 public:
  explicit Judgement(const JudgementInputs& inputs);
  OrderedJson Json() const;

 private:
  const std::string& score() const { return inputs_.world.description().figures.front().name; }
  void AddPolicy(OrderedJson& json) const;
  void AddOptimum(OrderedJson& json) const;
  void AddBaselines(OrderedJson& json) const;
  void AddEpisodes(OrderedJson& json) const;
  std::optional<Gaps> GapsOfPolicy() const;

  JudgementInputs inputs_;
  std::vector<std::pair<ReferencePolicy, PolicyFigures>> references_;
  std::vector<std::string> groups_;   // by episode
  bool found_ = false;                // there is a plan of every episode
  bool proved_ = false;               // and each is the optimum
  PolicyFigures best_found_;          // by the search; only if found_
  std::vector<double> least_scores_;  // by episode: the lower bounds; only if found_
};

Judgement::Judgement(const JudgementInputs& inputs) : inputs_(inputs) {
  for (const ReferencePolicy& policy : inputs.world.reference_policies()) {
    references_.emplace_back(policy, PolicyFigures());
    for (const uint64_t seed : inputs.seeds) {
      const Episode episode = inputs.world.FlyReference(policy.name, seed);
      references_.back().second.Add(inputs.world, episode);
      if (groups_.size() < inputs.seeds.size()) {
        groups_.push_back(inputs.world.GroupOf(episode));
      }
    }
  }
  const auto is_found = [](const auto& plan) { return plan != nullptr; };
  const auto is_proved = [](const auto& plan) { return plan != nullptr && plan->optimal; };
  found_ = !inputs.plans.empty() && std::all_of(inputs.plans.begin(), inputs.plans.end(), is_found);
  proved_ = found_ && std::all_of(inputs.plans.begin(), inputs.plans.end(), is_proved);
  for (size_t i = 0; i < inputs.plans.size() && found_; ++i) {
    best_found_.Add(inputs.world, inputs.plans[i]->flight);
    least_scores_.push_back(inputs.plans[i]->lower_bound_average_aoi);
  }
}

OrderedJson Judgement::Json() const {
  OrderedJson json = {{"world", WorldJson(inputs_.world.description())}};
  AddPolicy(json);
  if (CanPlan(inputs_.world)) {
    AddOptimum(json);
  }
  if (!references_.empty()) {
    AddBaselines(json);
  }
  if (inputs_.plans.size() > 1 && inputs_.policy != nullptr) {
    AddEpisodes(json);
  }
  return json;
}

void Judgement::AddPolicy(OrderedJson& json) const {
  const Evaluation* policy = inputs_.policy;
  json["score"] = policy == nullptr ? OrderedJson() : NumberJson(policy->score());
  json["success"] = policy == nullptr ? OrderedJson() : NumberJson(policy->success);
  AddFigures(inputs_.world, "", policy == nullptr ? nullptr : &policy->figures, json);
  json[inputs_.world.description().success] = policy == nullptr ? OrderedJson() : OrderedJson(policy->success == 1);
}

std::optional<Gaps> Judgement::GapsOfPolicy() const {
  const bool has_gap = proved_ && inputs_.policy != nullptr && inputs_.policy->success == 1;
  return has_gap ? std::optional(GapsOf(inputs_.policy->scores, least_scores_)) : std::nullopt;
}

void Judgement::AddOptimum(OrderedJson& json) const {
  const std::vector<double> found = found_ ? best_found_.Means() : std::vector<double>();
  double bound = 0;
  for (const double score : least_scores_) {
    bound += score / static_cast<double>(least_scores_.size());
  }
  AddFigures(inputs_.world, "optimal_", proved_ ? &found : nullptr, json);
  AddFigures(inputs_.world, "best_found_", found_ ? &found : nullptr, json);
  json["lower_bound_" + score()] = found_ ? NumberJson(bound) : OrderedJson();
  const std::optional<Gaps> gaps = GapsOfPolicy();
  json["gap_percent"] = gaps ? OrderedJson(gaps->mean) : OrderedJson();
  if (inputs_.plans.size() > 1) {
    json["gap_median_percent"] = gaps ? OrderedJson(gaps->median) : OrderedJson();
    json["gap_worst_percent"] = gaps ? OrderedJson(gaps->worst) : OrderedJson();
  }
}

void Judgement::AddBaselines(OrderedJson& json) const {
  OrderedJson& baselines = json["baselines"] = OrderedJson::object();
  for (const auto& [policy, figures] : references_) {
    OrderedJson& baseline = baselines[policy.name] = {{"title", policy.title}};
    const std::vector<double> means = figures.Means();
    AddFigures(inputs_.world, "", &means, baseline);
    baseline["success"] = NumberJson(figures.success());
    baseline[inputs_.world.description().success] = figures.success() == 1;
    if (CanPlan(inputs_.world)) {
      const bool has_gap = proved_ && figures.success() == 1;
      baseline["gap_percent"] =
          has_gap ? OrderedJson(GapsOf(figures.scores(), least_scores_).mean) : OrderedJson();
    }
  }
}

void Judgement::AddEpisodes(OrderedJson& json) const {
  OrderedJson& episodes = json["judged_episodes"] = OrderedJson::array();
  for (size_t i = 0; i < inputs_.seeds.size(); ++i) {
    OrderedJson episode = {{"seed", inputs_.seeds[i]}};
    if (!groups_.empty()) {
      episode["group"] = groups_[i];
    }
    const Plan* plan = inputs_.plans[i].get();
    const bool proved = plan != nullptr && plan->optimal;
    const double reached = inputs_.policy->scores[i];
    episode[score()] = reached;
    episode["optimal_" + score()] = proved ? OrderedJson(plan->lower_bound_average_aoi) : OrderedJson();
    episode["gap_percent"] =
        proved ? OrderedJson(GapPercent(reached, plan->lower_bound_average_aoi)) : OrderedJson();
    for (const auto& [policy, figures] : references_) {
      episode["baselines"][policy.name] = figures.scores()[i];
    }
    episodes.push_back(std::move(episode));
  }
}

}  // namespace

void PolicyFigures::Add(const World& world, const Episode& episode) {
  figures_.emplace_back(world.description().figures.size());
  world.Judge(episode, figures_.back());
  scores_.push_back(figures_.back().front());
  succeeded_.push_back(world.Succeeded(episode));
}

std::vector<double> PolicyFigures::Means() const {
  std::vector<double> means(figures_.front().size());
  for (size_t figure = 0; figure < means.size(); ++figure) {
    for (const std::vector<double>& figures : figures_) {
      means[figure] += figures[figure];
    }
    means[figure] /= static_cast<double>(figures_.size());
  }
  return means;
}

double PolicyFigures::success() const {
  const auto successes = std::count(succeeded_.begin(), succeeded_.end(), true);
  return static_cast<double>(successes) / static_cast<double>(succeeded_.size());
}

std::string JudgementJson(const JudgementInputs& inputs) {
  return Judgement(inputs).Json().dump();
}

}  // namespace fresco
