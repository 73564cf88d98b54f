// summary.json, read with a JSON parser and held against figures that are worked out here.
#include "storage/summary.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/bytes.h"
#include "tests/nn/literal_network.h"
#include "tests/training/literal_run.h"
#include "training/flyer.h"
#include "worlds/uav/baselines.h"

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
                                  run.world,
                                  run_id,
                                  run.trainer.finished(),
                                  4.0,
                                  run.trainer,
                                  DistinctCounters(),
                                  {std::move(plan), end}}));
}

std::string EightDigits(uint32_t value) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", value);
  return text;
}

/// The three figures over 14 slots, weights 1/3 and 2/3.
void ExpectFigures(const Json& json, const std::vector<State>& states) {
  int64_t total = 0;
  double weighted = 0;
  ASSERT_EQ(states.size(), 14u);
  for (const State& state : states) {
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
  EXPECT_EQ(summary.at("weights_crc32c"), EightDigits(Crc32c(SpanOf(run.weights.back()))));
}

TEST(Summary, GivesTheFiguresOfTheBestEvaluatedVersion) {
  FinishedRun run;
  const Json summary = SummaryOf(run);
  const auto version = summary.at("best_version").get<size_t>();
  const Episode greedy = FlyGreedily(run.world, run.experiment, run.current_versions.at(version));
  ExpectFigures(summary, greedy.states);
  for (const Evaluation& evaluation : run.evaluations) {
    EXPECT_GE(evaluation.figures.total_aoi, 0);
    EXPECT_GE(evaluation.figures.average_aoi, summary.at("average_aoi").get<double>());
  }
}

TEST(Summary, GivesTheFiguresOfBothBaselines) {
  const RecordedRun run;
  const Json baselines = SummaryOf(run).at("baselines");
  EXPECT_EQ(baselines.size(), 2u);
  for (const auto& [name, kind] :
       {std::pair("aoi", BaselineKind::kAoi), std::pair("distance", BaselineKind::kDistance)}) {
    ExpectFigures(baselines.at(name), FlyBaseline(run.world, kind).states);
  }
}

/// The optimum of the small field, or as if the search had been ended early.
std::shared_ptr<const Plan> PlanOf(const RecordedRun& run, bool proved) {
  Plan plan = PlanOptimally(run.world);
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
  const AoiFigures optimal = Figures(run.world, plan->flight);
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
  EXPECT_EQ(summary.at("best_found_total_aoi"), Figures(run.world, plan->flight).total_aoi);
  EXPECT_EQ(summary.at("best_found_average_aoi"), Figures(run.world, plan->flight).average_aoi);
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
  const Json optimum = Json::parse(OptimumJson(run.world, *plan));
  size_t next = 0;
  const Episode flight = Fly(run.world, [&](const Environment&) {
    return run.world.ActionAt(optimum.at("actions").at(next++).get<int>());
  });
  EXPECT_TRUE(flight.arrived());
  EXPECT_EQ(next, optimum.at("actions").size());
  EXPECT_EQ(Figures(run.world, flight).total_aoi, optimum.at("total_aoi"));
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
  for (const char* field : {"total_aoi", "average_aoi", "sum_aoi", "arrived"}) {
    EXPECT_TRUE(summary.at(field).is_null()) << field;
  }
  EXPECT_EQ(summary.at("completed"), false);
  EXPECT_EQ(summary.at("episodes"), 1);
  EXPECT_EQ(summary.at("updates"), 0);
  EXPECT_EQ(summary.at("weights_crc32c"), EightDigits(Crc32c(SpanOf(run.weights.front()))));
}

TEST(Summary, WritesEveryBitOfLargeRunIdsAndSeeds) {
  const RecordedRun run(Settings{{"schedule.seed", "18446744073709551615"}});
  const Json summary = SummaryOf(run, -2);
  EXPECT_EQ(summary.at("run_id"), "fffffffffffffffe");
  EXPECT_EQ(summary.at("seed").get<uint64_t>(), 18446744073709551615u);
}

}  // namespace
}  // namespace fresco
