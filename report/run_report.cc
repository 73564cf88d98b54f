#include "report/run_report.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "report/drawings.h"
#include "report/result_display.h"
#include "storage/metrics.h"
#include "storage/network_file.h"
#include "storage/plans.h"
#include "storage/policy.h"
#include "storage/run_folder.h"
#include "training/flyer.h"
#include "training/schedules.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

constexpr int64_t kManyUpdates = 10'000;  // shown in thousands

/// Whether a point has a score to show: in a world without chance, one that failed has none.
bool IsShown(const LearningPoint& point, const LearningCurve& curve) {
  return point.success > 0 || curve.world.random;
}

/// The best evaluation so far, as steps over the updates, in units of `updates_unit`.
Curve BestSoFar(const LearningCurve& curve, double updates_unit) {
  const bool less_is_better = curve.world.less_is_better;
  Curve best{.name = "best so far", .role = CurveRole::kDqn, .shape = CurveShape::kSteps};
  for (const LearningPoint& point : curve.points) {
    const bool last = &point == &curve.points.back();
    const bool better =
        IsShown(point, curve) &&
        (best.y.empty() || (less_is_better ? point.score < best.y.back() : point.score > best.y.back()));
    if (better || (last && !best.y.empty())) {
      best.x.push_back(static_cast<double>(point.updates) / updates_unit);
      best.y.push_back(better ? point.score : best.y.back());
    }
  }
  return best;
}

LinePlot PlotOverUpdates(const std::string& title, bool thousands, const LearningCurve& curve) {
  LinePlot plot{.title = title,
                .x_label = thousands ? "updates (thousands)" : "updates",
                .y_label = Label(curve.world.figures.front())};
  if (curve.optimum_score) {
    plot.references = {{"exact optimum", CurveRole::kOptimum, *curve.optimum_score}};
    plot.gap_base = curve.optimum_score;
  }
  return plot;
}

}  // namespace

LinePlot LearningCurvePlot(const LearningCurve& curve) {
  FRESCO_CHECK(!curve.points.empty());
  const bool thousands = curve.points.back().updates >= kManyUpdates;
  const double updates_unit = thousands ? 1000 : 1;
  Curve flights{.name = curve.world.random ? "mean of greedy episodes" : "greedy episode",
                .role = CurveRole::kDqn,
                .shape = CurveShape::kFaintDots};
  Curve failures{.name = "not " + Title(curve.world.success),
                 .role = CurveRole::kAoiBased,
                 .shape = CurveShape::kTopMarks};
  for (const LearningPoint& point : curve.points) {
    const double x = static_cast<double>(point.updates) / updates_unit;
    flights.x.push_back(x);
    flights.y.push_back(IsShown(point, curve) ? point.score : std::nan(""));
    if (!IsShown(point, curve)) {
      failures.x.push_back(x);
    }
  }
  LinePlot plot = PlotOverUpdates(curve.title, thousands, curve);
  plot.curves = {flights, failures, BestSoFar(curve, updates_unit)};
  return plot;
}

LinePlot BestSoFarPlot(const std::vector<LearningCurve>& curves) {
  int64_t updates = 0;
  for (const LearningCurve& curve : curves) {
    updates = std::max(updates, curve.points.empty() ? 0 : curve.points.back().updates);
  }
  const bool thousands = updates >= kManyUpdates;
  LearningCurve common = curves.front();
  for (const LearningCurve& curve : curves) {
    if (curve.optimum_score != common.optimum_score) {
      common.optimum_score.reset();
    }
  }
  LinePlot plot = PlotOverUpdates("Best evaluation so far", thousands, common);
  for (const LearningCurve& curve : curves) {
    Curve best = BestSoFar(curve, thousands ? 1000 : 1);
    if (!best.x.empty()) {
      best.name = curve.title;
      best.role = SeriesRole(plot.curves.size());
      plot.curves.push_back(std::move(best));
    }
  }
  return plot;
}

namespace {

constexpr char kSummary[] = "summary.json";

/// Returns the folder. Throws UsageError if it is not one of a run that has ended.
const Path& CheckEnded(const Path& folder) {
  if (const std::string reason = FinishedRun::WhyNone(folder); !reason.empty()) {
    throw UsageError(reason);
  }
  return folder;
}

}  // namespace

std::string FinishedRun::WhyNone(const Path& folder) {
  std::error_code error;
  if (std::filesystem::exists(folder / kSummary, error)) {
    return "";
  }
  const std::string found = std::filesystem::is_directory(folder, error)
                                ? fmt::format("has no {}{}", kSummary, NewestRunHint(folder, kSummary))
                                : "is no folder that can be read";
  return fmt::format("expected the folder of a run that has ended; \"{}\" {}", folder.string(), found);
}

FinishedRun::FinishedRun(const Path& folder)
    : folder_(CheckEnded(folder)),
      experiment_(Experiment::Load((folder / "config.textproto").string())),
      summary_(ReadFile(folder / kSummary)) {
  try {
    ReadLearningCurve();
  } catch (const std::exception& error) {
    throw UsageError(fmt::format("{}: expected summary.json and metrics.csv as the learner writes them; {}",
                                 folder.string(), error.what()));
  }
}

std::optional<uint64_t> FinishedRun::ShownSeed() const {
  if (!world().description().random) {
    return 0;
  }
  return experiment_.schedule().fixed_evaluation_episodes()
             ? std::optional(FixedDeliverySeeds(experiment_.schedule()).front())
             : std::nullopt;
}

std::optional<Episode> FinishedRun::FlyBest(uint64_t seed) const {
  if (!std::filesystem::exists(folder_ / "best.network")) {
    return std::nullopt;
  }
  const StoredNetwork network = ReadNetworkFile(folder_ / "best.network");
  return FlyGreedily(experiment_, seed, std::make_shared<const Vector>(network.parameters));
}

std::vector<ReportEpisode> FinishedRun::FlyReferences(uint64_t seed) const {
  std::vector<ReportEpisode> episodes;
  const std::vector<uint64_t> seeds = {seed};
  if (const std::shared_ptr<const Plan> plan = PlansIn(folder_, world(), seeds).front(); plan != nullptr) {
    episodes.push_back({FoundFlightName(plan->optimal), plan->flight});
  }
  for (const ReferencePolicy& policy : world().reference_policies()) {
    episodes.push_back({policy.title, world().FlyReference(policy.name, seed)});
  }
  return episodes;
}

std::vector<ReportEpisode> FinishedRun::FlyEpisodes() const {
  const std::optional<uint64_t> seed = ShownSeed();
  if (!seed) {
    return {};
  }
  std::vector<ReportEpisode> episodes = FlyReferences(*seed);
  if (std::optional<Episode> best = FlyBest(*seed)) {
    episodes.insert(episodes.begin(), {"this run (DQN)", *std::move(best)});
  }
  return episodes;
}

void FinishedRun::ReadLearningCurve() {
  const WorldDescription& description = world().description();
  const std::string& score_name = description.figures.front().name;
  learning_curve_.title = "Greedy episodes during the training";
  learning_curve_.world = description;
  const Json summary = Json::parse(summary_);
  const Json optimal =
      summary.value("evaluations_optimal_" + score_name, summary.value("optimal_" + score_name, Json()));
  if (!optimal.is_null()) {
    learning_curve_.optimum_score = optimal.get<double>();
  }
  const Path file = folder_ / "metrics.csv";
  if (!std::filesystem::exists(file)) {
    return;
  }
  const MetricsTable metrics = ParseMetrics(ReadFile(file));
  const size_t updates = metrics.ColumnOf("updates");
  const size_t score = metrics.ColumnOf(score_name);
  const size_t success = metrics.ColumnOf(description.success);
  for (const std::vector<double>& row : metrics.rows) {
    learning_curve_.points.push_back({static_cast<int64_t>(row[updates]), row[score], row[success]});
  }
}

ReportFigure WriteFigure(const Picture& picture, const Path& stem, const std::string& title,
                         const std::string& caption) {
  WritePicture(picture, stem);
  return {title, caption, ReadFile(stem.string() + ".svg")};
}

ReportTable PolicyTable(const std::string& summary_json) {
  const std::vector<std::vector<std::string>> rows = PolicyRows(summary_json);
  ReportTable table{"Policies", rows.front(), {}};
  table.rows.assign(rows.begin() + 1, rows.end());
  return table;
}

LinePlot GapPlot(const std::string& summary_json) {
  std::vector<double> gaps;
  std::vector<double> baselines;
  for (const JudgedEpisode& episode : ProvedEpisodes(summary_json)) {
    gaps.push_back(GapPercent(episode.score, episode.optimal_score));
    if (std::isfinite(episode.better_baseline)) {
      baselines.push_back(GapPercent(episode.better_baseline, episode.optimal_score));
    }
  }
  LinePlot plot{.title = "Gap to the exact optimum of each judged episode",
                .x_label = "share of the episodes with at most this gap [%]",
                .y_label = "gap [%]"};
  const auto add = [&](const std::string& name, CurveRole role, std::vector<double> values) {
    std::sort(values.begin(), values.end());
    Curve curve{.name = name, .role = role, .shape = CurveShape::kLine};
    for (size_t i = 0; i < values.size(); ++i) {
      curve.x.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(values.size()));
    }
    curve.y = std::move(values);
    plot.curves.push_back(std::move(curve));
  };
  if (!baselines.empty()) {
    add("better baseline", CurveRole::kAoiBased, baselines);
  }
  add("this run (DQN)", CurveRole::kDqn, gaps);
  plot.least_y = 0;
  return plot;
}

namespace {

/// Adds what is known of the gaps of single episodes.
void AddGaps(const std::string& summary_json, const Path& folder, ReportContents& contents) {
  const std::vector<std::vector<std::string>> rows = GapRows(summary_json);
  if (rows.empty()) {
    return;
  }
  contents.tables.push_back({"Gap to the exact optimum", rows.front(), {rows.begin() + 1, rows.end()}});
  try {
    contents.figures.push_back(WriteFigure(DrawLinePlot(GapPlot(summary_json)), folder / "gaps",
                                           "Distribution of the gap",
                                           "The judged episodes, sorted by their gap to the exact optimum."));
  } catch (const Error& error) {
    spdlog::warn("report.html has no picture of the gaps: {}", error.what());
  }
}

}  // namespace

void WriteRunReport(const Path& folder) {
  const FinishedRun run(folder);
  const Json summary = Json::parse(run.summary());
  ReportContents contents;
  const bool proved = run.learning_curve().optimum_score.has_value();
  contents.title = "Fresco: a trained policy" + std::string(proved ? " beside the exact optimum" : "");
  contents.summary = fmt::format(
      "{} training episodes, {} updates in {:.0f} s; seed {}, configuration {}, weights {}.{}",
      summary.at("episodes").get<int64_t>(), summary.at("updates").get<int64_t>(),
      summary.at("wall_s").get<double>(), summary.at("seed").get<uint64_t>(),
      summary.at("config_hash").get<std::string>(), summary.at("weights_crc32c").get<std::string>(),
      summary.at("completed").get<bool>() ? "" : " The run was interrupted before its end.");
  if (const std::string note = OptimumNote(run.summary()); !note.empty()) {
    contents.summary += " " + note;
  }
  contents.tables = {PolicyTable(run.summary())};
  if (!run.learning_curve().points.empty()) {
    try {
      contents.figures.push_back(WriteFigure(DrawLinePlot(LearningCurvePlot(run.learning_curve())),
                                             folder / "learning_curve", "Learning curve",
                                             "The evaluations of the network's versions."));
    } catch (const Error& error) {
      spdlog::warn("report.html has no learning curve: {}", error.what());
    }
  }
  AddGaps(run.summary(), folder, contents);
  if (DrawingOf(run.world()) != nullptr) {
    contents.episodes = run.FlyEpisodes();
    contents.world = &run.world();
  }
  contents.configuration = run.experiment().Text();
  WriteFileAtomically(folder / "report.html", ReportPage(contents));
}

}  // namespace fresco
