#include "report/run_report.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "report/result_display.h"
#include "storage/network_file.h"
#include "storage/policy.h"
#include "worlds/uav/baselines.h"

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

/// The best flight that the search found, from its actions in optimum.json.
Episode FlightOfOptimum(const World& world, const Json& optimum, const Path& file) {
  Episode flight;
  if (!FlyActions(world, {}, optimum.at("actions").get<std::vector<int16_t>>(), flight)) {
    throw Failure(file.string() + ": its actions are no flight of this run's scenario");
  }
  return flight;
}

}  // namespace

LinePlot LearningCurvePlot(const LearningCurve& curve) {
  FRESCO_CHECK(!curve.points.empty());
  constexpr int64_t kManyUpdates = 10'000;
  const bool thousands = curve.points.back().updates >= kManyUpdates;
  Curve flights{.name = "greedy flight", .role = CurveRole::kDqn, .shape = CurveShape::kFaintDots};
  Curve best{.name = "best so far", .role = CurveRole::kDqn, .shape = CurveShape::kSteps};
  Curve failures{.name = "did not arrive", .role = CurveRole::kAoiBased, .shape = CurveShape::kTopMarks};
  for (const LearningPoint& point : curve.points) {
    const double x = static_cast<double>(point.updates) / (thousands ? 1000 : 1);
    flights.x.push_back(x);
    flights.y.push_back(point.arrived ? point.average_aoi : std::nan(""));
    if (!point.arrived) {
      failures.x.push_back(x);
    }
    const bool last = &point == &curve.points.back();
    const bool better = point.arrived && (best.y.empty() || point.average_aoi < best.y.back());
    if (better || (last && !best.y.empty())) {
      best.x.push_back(x);
      best.y.push_back(better ? point.average_aoi : best.y.back());
    }
  }
  LinePlot plot{.title = curve.title,
                .x_label = thousands ? "updates (thousands)" : "updates",
                .y_label = "average AoI [slots]"};
  plot.curves = {flights, failures, best};
  if (curve.optimum_average_aoi) {
    plot.references = {{"exact optimum", CurveRole::kOptimum, *curve.optimum_average_aoi}};
    plot.gap_base = curve.optimum_average_aoi;
  }
  return plot;
}

FinishedRun::FinishedRun(const Path& folder)
    : experiment_(Experiment::Load((folder / "config.textproto").string())),
      world_(experiment_.scenario()),
      summary_(ReadFile(folder / "summary.json")) {
  AddFlights(folder);
  ReadLearningCurve(folder);
}

void FinishedRun::AddFlights(const Path& folder) {
  if (std::filesystem::exists(folder / "best.network")) {
    const StoredNetwork network = ReadNetworkFile(folder / "best.network");
    flights_.push_back({"this run (DQN)", FlyNetwork(world_, experiment_, network)});
  }
  if (std::filesystem::exists(folder / "optimum.json")) {
    const Path file = folder / "optimum.json";
    const Json optimum = Json::parse(ReadFile(file));
    flights_.push_back(
        {FoundFlightName(optimum.at("optimal").get<bool>()), FlightOfOptimum(world_, optimum, file)});
  }
  flights_.push_back({"AoI-based", FlyBaseline(world_, BaselineKind::kAoi)});
  flights_.push_back({"distance-based", FlyBaseline(world_, BaselineKind::kDistance)});
}

void FinishedRun::ReadLearningCurve(const Path& folder) {
  learning_curve_.title = "Greedy flights during training";
  const Json optimal = Json::parse(summary_).at("optimal_average_aoi");
  if (!optimal.is_null()) {
    learning_curve_.optimum_average_aoi = optimal.get<double>();
  }
  const Path file = folder / "metrics.csv";
  if (!std::filesystem::exists(file)) {
    return;
  }
  std::istringstream stream(ReadFile(file));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = Split(line);
  const size_t updates = ColumnOf(header, "updates", file);
  const size_t average_aoi = ColumnOf(header, "average_aoi", file);
  const size_t arrived = ColumnOf(header, "arrived", file);
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = Split(line);
    learning_curve_.points.push_back(
        {std::stoll(cells.at(updates)), std::stod(cells.at(average_aoi)), cells.at(arrived) == "1"});
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
  const bool proved = !summary.at("optimal_average_aoi").is_null();
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
                                             "One greedy flight of every evaluated version of the network."));
    } catch (const Error& error) {
      spdlog::warn("report.html has no learning curve: {}", error.what());
    }
  }
  contents.flights = run.flights();
  contents.world = &run.world();
  contents.configuration = run.experiment().Text();
  WriteFileAtomically(folder / "report.html", ReportPage(contents));
}

}  // namespace fresco
