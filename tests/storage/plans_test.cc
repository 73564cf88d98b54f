// Plans of several fields: planned one after the other, written, read, and what a policy is judged by.
#include "storage/plans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"
#include "core/files.h"
#include "storage/judgement.h"
#include "storage/optimum_search.h"
#include "tests/support/temporary_folder.h"
#include "training/schedules.h"
#include "worlds/uav/uav_fields.h"

namespace fresco {
namespace {

using Json = nlohmann::json;

constexpr int64_t kPlanningPatienceUs = 60'000'000;

/// Small fields of one or two sensors; two evaluation episodes and two of the delivery.
Experiment SmallFields() {
  return Experiment::Parse(
      "scenario { grid { columns: 5 rows: 5 } slots: 12 start { column: 0 row: 0 } stop { column: 4 row: 2 } "
      "random_sensors { per_episode: true minimum: 1 maximum: 2 } coverage_radius_m: 30 } "
      "agent { set_network { encoder_layers: [4] trunk_layers: [4] head_layers: [4] } safe_action_mask: true "
      "} "
      "schedule { evaluation_episodes: 2 fixed_evaluation_episodes: true }",
      "test");
}

/// Its plans, by a search of its own.
std::vector<std::shared_ptr<const Plan>> PlansOf(const Experiment& experiment,
                                                 std::vector<std::shared_ptr<const Plan>> known = {}) {
  OptimumSearch search(experiment.world(), EpisodesToPlan(experiment), {}, std::move(known));
  EXPECT_TRUE(search.WaitForEnd(kPlanningPatienceUs));
  EXPECT_EQ(search.result().end, SearchEnd::kProved);
  return search.result().plans;
}

TEST(EpisodesToPlan, AreThoseOfFixedEvaluationsAndOfTheDelivery) {
  const Experiment experiment = SmallFields();
  const std::vector<uint64_t> seeds = EpisodesToPlan(experiment);
  ASSERT_EQ(seeds.size(), 4u);
  for (size_t i = 0; i < seeds.size(); ++i) {
    EXPECT_EQ(seeds[i], EvaluationSeed(experiment.schedule().seed(), static_cast<int64_t>(i)));
  }
  EXPECT_EQ(EpisodesToPlan(Experiment::Parse("", "test")), std::vector<uint64_t>{0});
  EXPECT_TRUE(EpisodesToPlan(Experiment::Parse("cartpole {}", "test")).empty());
  EXPECT_TRUE(EpisodesToPlan(Experiment::Parse(SmallFields().Text(), "test",
                                               {{"schedule.fixed_evaluation_episodes", "false"}}))
                  .empty());
}

TEST(OptimumSearchOfFields, PlansEachOfThem) {
  const Experiment experiment = SmallFields();
  const UavFields& fields = *AsUavFields(experiment.world());
  const std::vector<uint64_t> seeds = EpisodesToPlan(experiment);
  const auto plans = PlansOf(experiment);
  ASSERT_EQ(plans.size(), seeds.size());
  for (size_t i = 0; i < plans.size(); ++i) {
    const Plan of_field = PlanOptimally(UavWorld(fields.Draw(seeds[i]), fields.options()), 0);
    EXPECT_EQ(plans[i]->lower_bound_average_aoi, of_field.lower_bound_average_aoi);
    EXPECT_EQ(plans[i]->flight.seed, seeds[i]);
    EXPECT_TRUE(fields.Succeeded(plans[i]->flight));
  }
}

TEST(OptimumSearchOfFields, DoesNotPlanAgainWhatIsKnown) {
  const Experiment experiment = SmallFields();
  auto known = PlansOf(experiment);
  known[2] = nullptr;
  const auto plans = PlansOf(experiment, known);
  for (const size_t i : {0u, 1u, 3u}) {
    EXPECT_EQ(plans[i], known[i]);
  }
  EXPECT_NE(plans[2], nullptr);
}

TEST(Gaps, AreMeanMedianAndWorst) {
  const std::vector<double> least = {10, 20, 5, 4};
  const Gaps four = GapsOf(std::vector<double>{11, 20, 10, 5}, least);  // 10, 0, 100 and 25 percent
  EXPECT_EQ(four.mean, 33.75);
  EXPECT_EQ(four.median, 17.5);
  EXPECT_EQ(four.worst, 100);
  const Gaps three = GapsOf(std::vector<double>{11, 20, 10}, std::span(least).first(3));
  EXPECT_EQ(three.median, 10);
}

TEST(Plans, AreReadAsTheyWereWritten) {
  const Experiment experiment = SmallFields();
  const std::vector<uint64_t> seeds = EpisodesToPlan(experiment);
  auto plans = PlansOf(experiment);
  plans[1] = nullptr;
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / kOptimumFile, OptimumJson(experiment.world(), seeds, plans));
  const std::vector<uint64_t> wanted = {seeds[3], 77, seeds[1], seeds[0]};
  const auto read = PlansIn(folder.path(), experiment.world(), wanted);
  ASSERT_EQ(read.size(), 4u);
  EXPECT_EQ(read[1], nullptr);
  EXPECT_EQ(read[2], nullptr);
  for (const auto& [found, written] : {std::pair(read[0], plans[3]), std::pair(read[3], plans[0])}) {
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->optimal, written->optimal);
    EXPECT_EQ(found->lower_bound_average_aoi, written->lower_bound_average_aoi);
    EXPECT_EQ(found->lower_bound_total_aoi, written->lower_bound_total_aoi);
    EXPECT_EQ(found->labels, written->labels);
    EXPECT_EQ(found->flight.seed, written->flight.seed);
    EXPECT_TRUE(SameBits(found->flight, written->flight));
  }
}

TEST(Plans, AreNoneIfTheFileIsMissingOrDamaged) {
  const Experiment experiment = SmallFields();
  const std::vector<uint64_t> seeds = EpisodesToPlan(experiment);
  const auto none = std::vector<std::shared_ptr<const Plan>>(seeds.size());
  const TemporaryFolder folder;
  EXPECT_EQ(PlansIn(folder.path(), experiment.world(), seeds), none);
  for (std::string text : {"", "[]", "{\"episodes\": 3}", "{\"episodes\": [{\"seed\": 1}]}", "\x01\x02"}) {
    WriteFileAtomically(folder.path() / kOptimumFile, text);
    EXPECT_EQ(PlansIn(folder.path(), experiment.world(), seeds), none) << text;
  }
  Json json = Json::parse(OptimumJson(experiment.world(), seeds, PlansOf(experiment)));
  json["episodes"][0]["actions"][0] = 10'000;
  WriteFileAtomically(folder.path() / kOptimumFile, json.dump());
  EXPECT_EQ(PlansIn(folder.path(), experiment.world(), seeds), none);
}

/// A policy with these scores, all of whose episodes arrived.
Evaluation PolicyOf(std::vector<double> scores) {
  const double mean = std::accumulate(scores.begin(), scores.end(), 0.0) / static_cast<double>(scores.size());
  return {1, 2, 3, 1, {mean, 0, 0}, std::move(scores)};
}

TEST(Judgement, ComparesAPolicyWithBaselinesAndOptimumOfEachEpisode) {
  const Experiment experiment = SmallFields();
  const World& world = experiment.world();
  const std::vector<uint64_t> seeds = EpisodesToPlan(experiment);
  const auto plans = PlansOf(experiment);
  std::vector<double> scores;
  std::vector<double> optima;
  for (const auto& plan : plans) {
    optima.push_back(plan->lower_bound_average_aoi);
    scores.push_back(optima.back() *
                     (1 + 0.1 * static_cast<double>(scores.size())));  // 0, 10, 20, 30 percent
  }
  const Evaluation policy = PolicyOf(scores);
  const Json json = Json::parse(JudgementJson({world, seeds, &policy, plans}));
  EXPECT_NEAR(json.at("gap_percent").get<double>(), 15, 1e-9);
  EXPECT_NEAR(json.at("gap_median_percent").get<double>(), 15, 1e-9);
  EXPECT_NEAR(json.at("gap_worst_percent").get<double>(), 30, 1e-9);
  EXPECT_NEAR(json.at("optimal_average_aoi").get<double>(),
              (optima[0] + optima[1] + optima[2] + optima[3]) / 4, 1e-12);
  ASSERT_EQ(json.at("judged_episodes").size(), 4u);
  double aoi = 0;
  double gap = 0;
  for (size_t i = 0; i < seeds.size(); ++i) {
    const Json& episode = json.at("judged_episodes").at(i);
    std::vector<double> figures(3);
    const Episode flown = world.FlyReference("aoi", seeds[i]);
    world.Judge(flown, figures);
    aoi += figures[0] / 4;
    gap += (figures[0] / optima[i] - 1) * 25;
    EXPECT_EQ(episode.at("seed"), seeds[i]);
    EXPECT_EQ(episode.at("group"), world.GroupOf(flown));
    EXPECT_EQ(episode.at("average_aoi"), scores[i]);
    EXPECT_EQ(episode.at("optimal_average_aoi"), optima[i]);
    EXPECT_EQ(episode.at("baselines").at("aoi"), figures[0]);
  }
  EXPECT_NEAR(json.at("baselines").at("aoi").at("average_aoi").get<double>(), aoi, 1e-12);
  EXPECT_NEAR(json.at("baselines").at("aoi").at("gap_percent").get<double>(), gap, 1e-9);
}

TEST(Judgement, HasNoGapUnlessEveryOptimumIsProved) {
  const Experiment experiment = SmallFields();
  const std::vector<uint64_t> seeds = EpisodesToPlan(experiment);
  auto plans = PlansOf(experiment);
  Plan unproved = *plans[1];
  unproved.optimal = false;
  plans[1] = std::make_shared<const Plan>(unproved);
  const Evaluation policy = PolicyOf({9, 9, 9, 9});
  const Json json = Json::parse(JudgementJson({experiment.world(), seeds, &policy, plans}));
  EXPECT_TRUE(json.at("gap_percent").is_null());
  EXPECT_TRUE(json.at("optimal_average_aoi").is_null());
  EXPECT_FALSE(json.at("best_found_average_aoi").is_null());
  EXPECT_TRUE(json.at("judged_episodes").at(1).at("gap_percent").is_null());
  EXPECT_FALSE(json.at("judged_episodes").at(0).at("gap_percent").is_null());
  plans[1] = nullptr;
  const Json less = Json::parse(JudgementJson({experiment.world(), seeds, &policy, plans}));
  EXPECT_TRUE(less.at("best_found_average_aoi").is_null());
  EXPECT_TRUE(less.at("lower_bound_average_aoi").is_null());
}

}  // namespace
}  // namespace fresco
