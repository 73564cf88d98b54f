// summary.json, read with a JSON parser and held against figures that are worked out here.
#include "storage/summary.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "core/bytes.h"
#include "tests/nn/literal_network.h"
#include "tests/training/literal_run.h"
#include "training/flyer.h"
#include "worlds/uav/aoi_figures.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

using Json = nlohmann::json;

BusCounters DistinctCounters() {
  BusCounters counters;
  counters.received = 11;
  counters.lost = 12;
  counters.duplicate = 13;
  counters.rejected = 14;
  counters.rejected_malformed = 15;
  counters.rejected_foreign = 16;
  counters.rejected_inconsistent = 17;
  counters.rejected_arithmetic = 18;
  counters.rejected_unauthenticated = 24;
  counters.reordered_episodes = 19;
  counters.stale_statuses = 20;
  counters.crowded_statuses = 21;
  counters.weights_chunks_sent = 22;
  counters.weights_chunks_repeated = 23;
  return counters;
}

Json SummaryOf(const RecordedRun& run, int64_t run_id = 0x2a, std::shared_ptr<const Plan> plan = nullptr,
               SearchEnd end = SearchEnd::kOff) {
  return Json::parse(SummaryJson({run.experiment,
                                  run_id,
                                  run.trainer.finished(),
                                  4.0,
                                  run.trainer,
                                  DistinctCounters(),
                                  {{std::move(plan)}, end}}));
}

std::string EightDigits(uint32_t value) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", value);
  return text;
}

const UavWorld& UavWorldOf(const RecordedRun& run) {
  return RequireUavWorld(run.world, "the test");
}

AoiFigures Figures(const RecordedRun& run, const Episode& flight) {
  return Figures(UavWorldOf(run), flight);
}

/// The three figures over 14 slots, weights 1/3 and 2/3.
void ExpectFigures(const Json& json, const std::vector<UavState>& states) {
  int64_t total = 0;
  double weighted = 0;
  ASSERT_EQ(states.size(), 14u);
  for (const UavState& state : states) {
    total += state.aoi[0] + state.aoi[1];
    weighted += (state.aoi[0] + 2 * state.aoi[1]) / 3.0;
  }
  EXPECT_EQ(json.at("total_aoi"), total);
  EXPECT_NEAR(json.at("average_aoi").get<double>(), weighted / 14, 1e-12);
  EXPECT_NEAR(json.at("sum_aoi").get<double>(), static_cast<double>(total) / 14, 1e-12);
  EXPECT_EQ(json.at("arrived"), true);
}

TEST(Summary, SaysWhatTheRunWas) {
  FinishedRun run;
  const Json summary = SummaryOf(run);
  EXPECT_EQ(summary.at("run_id"), "000000000000002a");
  EXPECT_EQ(summary.at("config_hash"), EightDigits(run.experiment.hash()));
  EXPECT_EQ(summary.at("seed"), 5);
  EXPECT_EQ(summary.at("completed"), true);
  EXPECT_EQ(summary.at("episodes"), 60);
  EXPECT_EQ(summary.at("transitions"), 780);
  EXPECT_EQ(summary.at("updates"), 371);
  EXPECT_EQ(summary.at("wall_s"), 4.0);
  EXPECT_EQ(summary.at("updates_per_s"), 92.75);
  EXPECT_EQ(summary.at("transitions_per_s"), 195.0);
  EXPECT_EQ(summary.at("weights_crc32c"), EightDigits(Crc32c(Values(run.weights.back()))));
}

TEST(Summary, GivesTheFiguresOfTheBestEvaluatedVersion) {
  FinishedRun run;
  const Json summary = SummaryOf(run);
  const auto version = summary.at("best_version").get<size_t>();
  const Episode greedy = FlyGreedily(run.experiment, 0, run.current_versions.at(version));
  ExpectFigures(summary, StatesIn(greedy));
  EXPECT_EQ(summary.at("score"), summary.at("average_aoi"));
  EXPECT_EQ(summary.at("success"), 1);
  EXPECT_EQ(summary.at("evaluation_episodes"), 1);
  for (const Evaluation& evaluation : run.evaluations) {
    EXPECT_TRUE(evaluation.success == 0 || evaluation.score() >= summary.at("average_aoi").get<double>());
  }
}

TEST(Summary, GivesTheFiguresOfBothBaselines) {
  const RecordedRun run;
  const Json baselines = SummaryOf(run).at("baselines");
  EXPECT_EQ(baselines.size(), 2u);
  EXPECT_EQ(baselines.at("aoi").at("title"), "AoI-based");
  EXPECT_EQ(baselines.at("distance").at("title"), "distance-based");
  for (const auto& [name, kind] :
       {std::pair("aoi", BaselineKind::kAoi), std::pair("distance", BaselineKind::kDistance)}) {
    ExpectFigures(baselines.at(name), StatesIn(FlyBaseline(UavWorldOf(run), kind)));
  }
}

/// The optimum of the small field, or as if the search had been ended early.
std::shared_ptr<const Plan> PlanOf(const RecordedRun& run, bool proved) {
  Plan plan = PlanOptimally(UavWorldOf(run), 0);
  if (!proved) {
    plan.optimal = false;
    plan.lower_bound_average_aoi *= 0.75;
  }
  return std::make_shared<const Plan>(plan);
}

TEST(Summary, GivesTheOptimumAndTheGapToIt) {
  FinishedRun run;
  const auto plan = PlanOf(run, true);
  const Json summary = SummaryOf(run, 1, plan);
  const AoiFigures optimal = Figures(run, plan->flight);
  EXPECT_EQ(summary.at("optimal_total_aoi"), optimal.total_aoi);
  EXPECT_EQ(summary.at("optimal_average_aoi"), optimal.average_aoi);
  const double average_aoi = summary.at("average_aoi").get<double>();
  EXPECT_GE(average_aoi, optimal.average_aoi);
  EXPECT_NEAR(summary.at("gap_percent").get<double>(), (average_aoi / optimal.average_aoi - 1) * 100, 1e-9);
}

TEST(Summary, HasALowerBoundAndNoGapIfTheOptimumIsNotProved) {
  FinishedRun run;
  const auto plan = PlanOf(run, false);
  const Json summary = SummaryOf(run, 1, plan);
  EXPECT_TRUE(summary.at("optimal_total_aoi").is_null());
  EXPECT_TRUE(summary.at("optimal_average_aoi").is_null());
  EXPECT_EQ(summary.at("lower_bound_average_aoi"), plan->lower_bound_average_aoi);
  EXPECT_EQ(summary.at("best_found_total_aoi"), Figures(run, plan->flight).total_aoi);
  EXPECT_EQ(summary.at("best_found_average_aoi"), Figures(run, plan->flight).average_aoi);
  EXPECT_TRUE(summary.at("gap_percent").is_null());
}

TEST(Summary, SaysHowTheSearchEndedAndWhetherSomethingIsLeftToDo) {
  RecordedRun unfinished;
  EXPECT_FALSE(IsFinished(SummaryOf(unfinished).dump()));
  FinishedRun run;
  for (const auto& [end, name, finished] :
       {std::tuple(SearchEnd::kOff, "off", true), std::tuple(SearchEnd::kProved, "proved", true),
        std::tuple(SearchEnd::kLimit, "limit", true), std::tuple(SearchEnd::kStopped, "stopped", false),
        std::tuple(SearchEnd::kFailed, "failed", true)}) {
    const Json summary = SummaryOf(run, 1, nullptr, end);
    EXPECT_EQ(summary.at("optimum_search"), name);
    EXPECT_EQ(IsFinished(summary.dump()), finished) << name;
  }
  EXPECT_FALSE(IsFinished("no summary"));
}

TEST(Summary, HasNoGapWithoutASearchOrAnEvaluation) {
  RecordedRun run;
  for (const char* field :
       {"optimal_total_aoi", "best_found_total_aoi", "lower_bound_average_aoi", "gap_percent"}) {
    EXPECT_TRUE(SummaryOf(run).at(field).is_null()) << field;
  }
  EXPECT_TRUE(SummaryOf(run, 1, PlanOf(run, true)).at("gap_percent").is_null());
}

TEST(Summary, WritesTheOptimumAsActionsThatFlyIt) {
  const RecordedRun run;
  const auto plan = PlanOf(run, true);
  const std::vector<uint64_t> seeds = {0};
  const Json optimum = Json::parse(OptimumJson(run.world, seeds, std::vector{plan})).at("episodes").at(0);
  size_t next = 0;
  const Episode flight = Fly(UavWorldOf(run), [&](const UavEnvironment&) {
    return UavWorldOf(run).ActionAt(optimum.at("actions").at(next++).get<int>());
  });
  EXPECT_TRUE(Arrived(flight));
  EXPECT_EQ(next, optimum.at("actions").size());
  EXPECT_EQ(Figures(run, flight).total_aoi, optimum.at("total_aoi"));
  EXPECT_EQ(optimum.at("optimal"), true);
}

TEST(Summary, CountsWhatHappenedOnTheBus) {
  const RecordedRun run;
  EXPECT_EQ(SummaryOf(run).at("bus"), Json::parse(R"({
    "received": 11, "lost": 12, "duplicate": 13, "rejected": 14, "rejected_malformed": 15,
    "rejected_foreign": 16, "rejected_inconsistent": 17, "rejected_arithmetic": 18,
    "rejected_unauthenticated": 24, "reordered_episodes": 19, "stale_statuses": 20, "crowded_statuses": 21,
    "weights_chunks_sent": 22, "weights_chunks_repeated": 23})"));
}

TEST(Summary, HasNoFiguresBeforeTheFirstEvaluation) {
  RecordedRun run;
  run.Commit(run.Fly(run.next()));
  const Json summary = SummaryOf(run);
  for (const char* field :
       {"total_aoi", "average_aoi", "sum_aoi", "arrived", "score", "success", "best_version"}) {
    EXPECT_TRUE(summary.at(field).is_null()) << field;
  }
  EXPECT_EQ(summary.at("completed"), false);
  EXPECT_EQ(summary.at("episodes"), 1);
  EXPECT_EQ(summary.at("updates"), 0);
  EXPECT_EQ(summary.at("weights_crc32c"), EightDigits(Crc32c(Values(run.weights.front()))));
}

TEST(Summary, NamesTheWorldAndItsFigures) {
  EXPECT_EQ(SummaryOf(RecordedRun()).at("world"),
            Json::parse(R"({"name": "uav", "success": "arrived", "figures": [
    {"name": "average_aoi", "unit": "slots"}, {"name": "total_aoi", "unit": "slots"},
    {"name": "sum_aoi", "unit": "slots"}]})"));
}

std::set<std::string> KeysOf(const Json& json) {
  std::set<std::string> keys;
  for (const auto& [key, value] : json.items()) {
    keys.insert(key);
  }
  return keys;
}

TEST(CartPoleSummary, HasNothingOfAnOptimumOrBaselines) {
  const FinishedRun run(SmallCartPole());
  const Json summary = SummaryOf(run);
  EXPECT_EQ(KeysOf(summary), (std::set<std::string>{"run_id",
                                                    "config_hash",
                                                    "seed",
                                                    "completed",
                                                    "episodes",
                                                    "transitions",
                                                    "updates",
                                                    "wall_s",
                                                    "score",
                                                    "success",
                                                    "return",
                                                    "balanced",
                                                    "updates_per_s",
                                                    "transitions_per_s",
                                                    "world",
                                                    "best_version",
                                                    "bus",
                                                    "weights_crc32c",
                                                    "checkpoints",
                                                    "staleness_updates",
                                                    "resumptions",
                                                    "updating",
                                                    "processor_s",
                                                    "software_version",
                                                    "evaluation_episodes"}));
  EXPECT_EQ(summary.at("world"), Json::parse(R"({"name": "cartpole", "success": "balanced",
    "figures": [{"name": "return", "unit": ""}]})"));
  EXPECT_TRUE(IsFinished(summary.dump()));
}

TEST(CartPoleSummary, GivesTheTimesOfUpdatingInSeconds) {
  const FinishedRun run(SmallCartPole());
  EXPECT_EQ(SummaryOf(run).at("updating"), Json());
  EXPECT_EQ(SummaryOf(run).at("processor_s"), Json());
  SummaryInputs inputs{run.experiment, 1, true, 4.0, run.trainer, {}};
  inputs.updating = {2'500'000, 1'000, 2'000'000, 3'000'000};
  EXPECT_EQ(Json::parse(SummaryJson(inputs)).at("updating"),
            Json::parse(R"({"wall_s": 2.5, "updates": 1000, "training_thread_s": 2, "learner_s": 3})"));
  inputs.processor = {4'000'000, 2'500'000, 8'500'000};
  inputs.optimum.processor_seconds = 0.5;
  EXPECT_EQ(Json::parse(SummaryJson(inputs)).at("processor_s"),
            Json::parse(R"({"learner": 4, "training_thread": 2.5, "optimum_search": 0.5, "actors": 8.5})"));
}

// In CartPole an episode's figure is the number of its steps, and it succeeds with the most of these.
TEST(CartPoleSummary, GivesTheMeansOfFreshEpisodesWithTheBestVersion) {
  const FinishedRun run(SmallCartPole());
  const Json summary = SummaryOf(run);
  EXPECT_EQ(summary.at("evaluation_episodes"), 3);
  const auto version = summary.at("best_version").get<size_t>();
  double steps = 0;
  int balanced = 0;
  for (size_t i = run.orders.size() - 3; i < run.orders.size(); ++i) {  // the last orders of a run are these
    const Order& order = run.orders.at(i);
    EXPECT_EQ(order.kind, OrderKind::kEvaluate);
    const auto delivered = static_cast<size_t>(order.current_version);
    EXPECT_TRUE(*run.current_versions.at(delivered) == *run.current_versions.at(version));
    const Episode episode = FlyGreedily(run.experiment, order.seed, run.current_versions.at(delivered));
    steps += episode.transitions();
    balanced += episode.transitions() == 12 ? 1 : 0;
  }
  EXPECT_NEAR(summary.at("return").get<double>(), steps / 3, 1e-12);
  EXPECT_EQ(summary.at("score"), summary.at("return"));
  EXPECT_NEAR(summary.at("success").get<double>(), balanced / 3.0, 1e-12);
  EXPECT_EQ(summary.at("balanced"), balanced == 3);
}

TEST(CartPoleSummary, HasNoFiguresBeforeTheFirstEvaluation) {
  const RecordedRun run(SmallCartPole());
  const Json summary = SummaryOf(run);
  for (const char* field : {"return", "balanced", "score", "success", "best_version"}) {
    EXPECT_TRUE(summary.at(field).is_null()) << field;
  }
}

TEST(Summary, WritesEveryBitOfLargeRunIdsAndSeeds) {
  const RecordedRun run(Settings{{"schedule.seed", "18446744073709551615"}});
  const Json summary = SummaryOf(run, -2);
  EXPECT_EQ(summary.at("run_id"), "fffffffffffffffe");
  EXPECT_EQ(summary.at("seed").get<uint64_t>(), 18446744073709551615u);
}

}  // namespace
}  // namespace fresco
