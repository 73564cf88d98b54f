#include "report/run_report.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "report/drawings.h"
#include "report/result_display.h"
#include "storage/network_file.h"
#include "storage/policy.h"
#include "training/flyer.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell);
  }
  return cells;
}

size_t ColumnOf(const std::vector<std::string>& header, const std::string& name, const Path& file) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) {
    throw UsageError(fmt::format("{}: expected a column {}, found none", file.string(), name));
  }
  return static_cast<size_t>(found - header.begin());
}

/// The best episode that the search found, from its actions in optimum.json.
Episode EpisodeOfOptimum(const World& world, const Json& optimum, const Path& file) {
  Episode episode;
  if (!FlyActions(world, 0, optimum.at("actions").get<std::vector<int16_t>>(), episode)) {
    throw Failure(file.string() + ": its actions are no episode of this run's world");
  }
  return episode;
}

std::string Label(const Quantity& quantity) {
  return Title(quantity.name) + (quantity.unit.empty() ? "" : " [" + quantity.unit + "]");
}

}  // namespace

LinePlot LearningCurvePlot(const LearningCurve& curve) {
  FRESCO_CHECK(!curve.points.empty());
  constexpr int64_t kManyUpdates = 10'000;
  const bool thousands = curve.points.back().updates >= kManyUpdates;
  const bool less_is_better = curve.world.less_is_better;
  Curve flights{.name = curve.world.random ? "mean of greedy episodes" : "greedy episode",
                .role = CurveRole::kDqn,
                .shape = CurveShape::kFaintDots};
  Curve best{.name = "best so far", .role = CurveRole::kDqn, .shape = CurveShape::kSteps};
  Curve failures{.name = "not " + Title(curve.world.success),
                 .role = CurveRole::kAoiBased,
                 .shape = CurveShape::kTopMarks};
  for (const LearningPoint& point : curve.points) {
    const double x = static_cast<double>(point.updates) / (thousands ? 1000 : 1);
    flights.x.push_back(x);
    const bool shown = point.success > 0 || curve.world.random;
    flights.y.push_back(shown ? point.score : std::nan(""));
    if (!shown) {
      failures.x.push_back(x);
    }
    const bool last = &point == &curve.points.back();
    const bool better =
        shown &&
        (best.y.empty() || (less_is_better ? point.score < best.y.back() : point.score > best.y.back()));
    if (better || (last && !best.y.empty())) {
      best.x.push_back(x);
      best.y.push_back(better ? point.score : best.y.back());
    }
  }
  LinePlot plot{.title = curve.title,
                .x_label = thousands ? "updates (thousands)" : "updates",
                .y_label = Label(curve.world.figures.front())};
  plot.curves = {flights, failures, best};
  if (curve.optimum_score) {
    plot.references = {{"exact optimum", CurveRole::kOptimum, *curve.optimum_score}};
    plot.gap_base = curve.optimum_score;
  }
  return plot;
}

FinishedRun::FinishedRun(const Path& folder)
    : folder_(folder),
      experiment_(Experiment::Load((folder / "config.textproto").string())),
      summary_(ReadFile(folder / "summary.json")) {
  ReadLearningCurve();
}

std::vector<ReportEpisode> FinishedRun::FlyEpisodes() const {
  std::vector<ReportEpisode> episodes;
  if (world().description().random) {
    return episodes;
  }
  if (std::filesystem::exists(folder_ / "best.network")) {
    const StoredNetwork network = ReadNetworkFile(folder_ / "best.network");
    episodes.push_back(
        {"this run (DQN)", FlyGreedily(experiment_, 0, std::make_shared<const Vector>(network.parameters))});
  }
  if (std::filesystem::exists(folder_ / "optimum.json")) {
    const Path file = folder_ / "optimum.json";
    const Json optimum = Json::parse(ReadFile(file));
    episodes.push_back(
        {FoundFlightName(optimum.at("optimal").get<bool>()), EpisodeOfOptimum(world(), optimum, file)});
  }
  for (const ReferencePolicy& policy : world().reference_policies()) {
    episodes.push_back({policy.title, world().FlyReference(policy.name)});
  }
  return episodes;
}

void FinishedRun::ReadLearningCurve() {
  const WorldDescription& description = world().description();
  const std::string& score_name = description.figures.front().name;
  learning_curve_.title = "Greedy episodes during the training";
  learning_curve_.world = description;
  const Json optimal = Json::parse(summary_).value("optimal_" + score_name, Json());
  if (!optimal.is_null()) {
    learning_curve_.optimum_score = optimal.get<double>();
  }
  const Path file = folder_ / "metrics.csv";
  if (!std::filesystem::exists(file)) {
    return;
  }
  std::istringstream stream(ReadFile(file));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = Split(line);
  const size_t updates = ColumnOf(header, "updates", file);
  const size_t score = ColumnOf(header, score_name, file);
  const size_t success = ColumnOf(header, description.success, file);
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = Split(line);
    learning_curve_.points.push_back(
        {std::stoll(cells.at(updates)), std::stod(cells.at(score)), std::stod(cells.at(success))});
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
  if (DrawingOf(run.world()) != nullptr) {
    contents.episodes = run.FlyEpisodes();
    contents.world = &run.world();
  }
  contents.configuration = run.experiment().Text();
  WriteFileAtomically(folder / "report.html", ReportPage(contents));
}

}  // namespace fresco
