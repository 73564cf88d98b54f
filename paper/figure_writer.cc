#include "paper/figure_writer.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "core/csv.h"
#include "core/error.h"
#include "core/files.h"
#include "paper/flight_map.h"
#include "paper/study_statistics.h"
#include "report/result_display.h"
#include "report/run_report.h"
#include "storage/policy.h"
#include "worlds/uav/baselines.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

/// A figure of the average AoI against R or N: its file, its texts and the name of x in the CSV file.
struct DeploymentFigure {
  Figure figure;
  const char* file;
  const char* title;
  const char* x_label;
  const char* x_column;
};
constexpr DeploymentFigure kDeploymentFigures[] = {
    {Figure::kRadius, "radius", "Effect of the coverage radius", "coverage radius R (cells)", "radius_cells"},
    {Figure::kSensors, "sensors", "Effect of the number of sensors", "number of sensors N", "sensors"},
};

/// A figure of the average AoI against the energy budget.
struct EnergyFigure {
  Figure figure;
  const char* file;
  const char* title;
  const char* caption;
};
constexpr EnergyFigure kEnergyFigures[] = {
    {Figure::kEnergy, "energy", "Effect of the energy budget, Table I's rotor",
     "Hovering takes more power (219.8 W against 112.9 W in flight): the budget limits the hovers, and the "
     "optimum hardly needs any. DQN was trained at the marked budgets."},
    {Figure::kEnergyDearFlight, "energy_dear_flight", "Effect of the energy budget, flying takes more power",
     "With the rotor usual in the literature, flight takes more power (249 W against 168.5 W hovering): the "
     "budget limits how far the UAV flies. DQN was trained at the marked budgets."},
};

/// Returns the name of the file that shows the flight with this name, without extension.
std::string FlightFile(const std::string& name) {
  const std::pair<std::string, const char*> files[] = {{FoundFlightName(true), "flight_optimal"},
                                                       {FoundFlightName(false), "flight_best_found"},
                                                       {"AoI-based", "flight_aoi"},
                                                       {"distance-based", "flight_distance"}};
  for (const auto& [flight, file] : files) {
    if (flight == name) {
      return file;
    }
  }
  return "flight_dqn";
}

/// Writes all files of a study.
class FigureWriter {
 public:
  FigureWriter(Path folder, const Experiment& base, const PaperStudy& study,
               const std::vector<StudyResult>& results)
      : folder_(std::move(folder)), base_(base), study_(study), results_(results) {}

  WrittenFigures Write() {
    WriteRuns();
    for (const DeploymentFigure& figure : kDeploymentFigures) {
      WriteDeploymentFigure(figure);
    }
    for (const EnergyFigure& figure : kEnergyFigures) {
      WriteEnergyFigure(figure);
    }
    const FinishedRun field(folder_ / "runs" / study_.jobs.front().name);
    WriteField(field);
    WriteReport(field);
    const auto unproved = std::count_if(results_.begin(), results_.end(),
                                        [](const StudyResult& result) { return !result.gap_percent; });
    return {MeanGap(), static_cast<int>(unproved), picture_error_};
  }

 private:
  void Draw(const Picture& picture, const std::string& file, const std::string& title,
            const std::string& caption) {
    try {
      contents_.figures.push_back(WriteFigure(picture, folder_ / file, title, caption));
    } catch (const Error& error) {
      picture_error_ = error.what();
    }
  }

  void WriteRuns() const {
    std::vector<std::vector<CsvCell>> rows;
    for (size_t job = 0; job < study_.jobs.size(); ++job) {
      const StudyResult& result = results_[job];
      if (!result.gap_percent) {
        spdlog::warn("the optimum of {} is not proved, so it has no gap", study_.jobs[job].name);
      }
      rows.push_back({study_.jobs[job].name, fmt::format("{:08x}", study_.jobs[job].experiment.hash()),
                      int64_t{result.arrived}, result.dqn.total_aoi, result.aoi_based.total_aoi,
                      result.distance_based.total_aoi,
                      result.optimal ? CsvCell(result.optimal->total_aoi) : CsvCell(std::string()),
                      result.dqn.average_aoi, result.lower_bound_average_aoi, CellOrEmpty(result.gap_percent),
                      result.updates, result.weights_crc32c});
    }
    WriteCsv(folder_ / "runs.csv",
             {"run", "config_hash", "dqn_arrived", "dqn_total_aoi", "aoi_total_aoi", "distance_total_aoi",
              "optimal_total_aoi", "dqn_average_aoi", "lower_bound_average_aoi", "gap_percent", "updates",
              "weights_crc32c"},
             rows);
  }

  void WriteDeploymentFigure(const DeploymentFigure& figure) {
    const std::vector<Group> groups = GroupsOf(study_, results_, figure.figure);
    WriteGroups(folder_ / fmt::format("{}.csv", figure.file), figure.x_column, groups);
    contents_.tables.push_back(GroupTable(figure.title, figure.x_label, groups));
    LinePlot plot{figure.title, figure.x_label, "average AoI (slots)"};
    plot.integer_x_tics = true;
    plot.least_y = 0;
    for (const Policy& policy : kPolicies) {
      Curve curve{policy.name, policy.role};
      constexpr double kAside = 0.05;  // shifts the bars, so that those of different policies do not overlap
      curve.bars_aside = kAside * (static_cast<double>(plot.curves.size()) - 1.5);
      for (const Group& group : groups) {
        if (const std::optional<MeanEstimate> estimate = group.Average(policy)) {
          curve.x.push_back(group.x);
          curve.y.push_back(estimate->mean);
          curve.half_widths.push_back(estimate->half_width.value_or(0));
        }
      }
      plot.curves.push_back(std::move(curve));
    }
    const size_t deployments = groups.front().results.size();
    Draw(DrawLinePlot(plot), figure.file, figure.title,
         fmt::format("Mean over {} random deployment{}{}.", deployments, deployments == 1 ? "" : "s",
                     deployments > 1 ? " with its 95 % confidence interval (Student's t)" : ""));
  }

  /// The curves of the baselines and the optimum have more budgets than those that DQN was trained at.
  void WriteEnergyFigure(const EnergyFigure& figure) {
    const std::vector<Group> groups = GroupsOf(study_, results_, figure.figure);
    LinePlot plot{figure.title, "energy budget (J)", "average AoI (slots)"};
    for (const Policy& policy : kPolicies) {
      const bool trained = policy.role == CurveRole::kDqn;
      plot.curves.push_back({policy.name, policy.role, trained ? CurveShape::kMarkers : CurveShape::kSteps});
    }
    std::vector<std::vector<CsvCell>> rows;
    for (const double budget_j : BudgetsOf(figure.figure, groups)) {
      const auto group = std::find_if(groups.begin(), groups.end(),
                                      [&](const Group& candidate) { return candidate.x == budget_j; });
      const StudyResult result =
          group != groups.end() ? group->results.front() : WithoutTraining(figure.figure, budget_j);
      std::vector<CsvCell> row = {budget_j};
      for (size_t i = 0; i < std::size(kPolicies); ++i) {
        const bool trained = kPolicies[i].role != CurveRole::kDqn || group != groups.end();
        const std::optional<PolicyResult> reached = trained ? kPolicies[i].result(result) : std::nullopt;
        row.push_back(reached ? CsvCell(reached->average_aoi) : CsvCell(std::string()));
        if (reached) {
          plot.curves[i].x.push_back(budget_j);
          plot.curves[i].y.push_back(reached->average_aoi);
        }
      }
      rows.push_back(std::move(row));
    }
    WriteCsv(folder_ / fmt::format("{}.csv", figure.file),
             {"initial_energy_j", "dqn_average_aoi", "aoi_average_aoi", "distance_average_aoi",
              "optimal_average_aoi"},
             rows);
    std::rotate(plot.curves.begin(), plot.curves.begin() + 1, plot.curves.end());  // DQN's marks on top
    Draw(DrawLinePlot(plot), figure.file, figure.title, figure.caption);
  }

  /// The budgets at which DQN was trained and, unless the study is a quick one, twenty steps over their
  /// range.
  std::vector<double> BudgetsOf(Figure figure, const std::vector<Group>& groups) const {
    std::vector<double> budgets;
    for (const Group& group : groups) {
      budgets.push_back(group.x);
    }
    constexpr int kSteps = 20;
    for (int step = 0; groups.size() > 2 && step <= kSteps; ++step) {
      budgets.push_back(BudgetOfShare(base_, figure, static_cast<double>(step) / kSteps));
    }
    std::sort(budgets.begin(), budgets.end());
    budgets.erase(std::unique(budgets.begin(), budgets.end()), budgets.end());
    return budgets;
  }

  StudyResult WithoutTraining(Figure figure, double budget_j) const {
    const Experiment experiment = WithBudget(base_, figure, budget_j);
    const UavWorld& world = RequireUavWorld(experiment.world(), "the figures");
    const auto result_of = [&](const Episode& flight) {
      const AoiFigures figures = Figures(world, flight);
      return PolicyResult{figures.average_aoi, figures.total_aoi};
    };
    StudyResult result;
    result.aoi_based = result_of(FlyBaseline(world, BaselineKind::kAoi));
    result.distance_based = result_of(FlyBaseline(world, BaselineKind::kDistance));
    const Plan plan = PlanWithin(world, 0, {});
    if (plan.optimal) {
      result.optimal = result_of(plan.flight);
    }
    return result;
  }

  void WriteField(const FinishedRun& field) {
    const UavWorld& world = RequireUavWorld(field.world(), "the figures");
    const LearningCurve& curve = field.learning_curve();
    std::vector<std::vector<CsvCell>> rows;
    for (const LearningPoint& point : curve.points) {
      rows.push_back(
          {point.updates, point.score, int64_t{point.success == 1}, CellOrEmpty(curve.optimum_score)});
    }
    WriteCsv(folder_ / "learning_curve.csv", {"updates", "average_aoi", "arrived", "optimal_average_aoi"},
             rows);
    Draw(DrawLinePlot(LearningCurvePlot(curve)), "learning_curve", "Learning curve",
         "One greedy flight of every evaluated version of one run's network.");
    contents_.episodes = field.FlyEpisodes();
    for (const ReportEpisode& flight : contents_.episodes) {
      const std::string file = FlightFile(flight.name);
      WriteFlightCsv(folder_ / fmt::format("{}.csv", file), world, flight.episode);
      const std::string title = "Flight: " + flight.name;
      Draw(DrawFlightMap(title, world, flight.episode), file, title,
           "The path's colour is the slot; a dot joined with a sensor is a collection.");
    }
  }

  static void WriteFlightCsv(const Path& path, const UavWorld& world, const Episode& flight) {
    std::vector<std::string> header = {"slot", "column", "row", "move", "scheduled"};
    for (size_t sensor = 1; sensor <= static_cast<size_t>(world.sensors()); ++sensor) {
      header.push_back(fmt::format("aoi_{}", sensor));
    }
    std::vector<std::vector<CsvCell>> rows;
    for (size_t slot = 0; slot <= flight.actions.size(); ++slot) {
      const UavState state = StateIn(flight, slot);
      const Action action = ActionIn(world, flight, slot);
      std::vector<CsvCell> row = {int64_t{state.slot}, int64_t{state.cell.column}, int64_t{state.cell.row},
                                  MoveName(action.move), int64_t{action.schedule}};
      row.insert(row.end(), state.aoi.begin(), state.aoi.end());
      rows.push_back(std::move(row));
    }
    WriteCsv(path, header, rows);
  }

  void WriteReport(const FinishedRun& field) {
    contents_.title = "Fresco: the paper's evaluation with the exact optimum";
    contents_.summary = fmt::format("{} runs trained over LCM.", study_.jobs.size());
    if (const std::optional<double> mean_gap = MeanGap()) {
      contents_.summary += fmt::format(
          " Over the two figures of the paper the trained policies lie {:.2f} % above the exact optimum on "
          "average. Runs whose optimum is not proved have no gap.",
          *mean_gap);
    }
    ReportTable policies = PolicyTable(field.summary());
    policies.title = "One field, flown below";
    contents_.tables.push_back(std::move(policies));
    contents_.world = &field.world();
    contents_.configuration = base_.Text();
    WriteFileAtomically(folder_ / "report.html", ReportPage(contents_));
  }

  /// The mean gap over all rows of the paper's two figures that have one.
  std::optional<double> MeanGap() const {
    double sum = 0;
    int rows = 0;
    for (const DeploymentFigure& figure : kDeploymentFigures) {
      for (const Group& group : GroupsOf(study_, results_, figure.figure)) {
        if (const std::optional<MeanEstimate> gap = group.Gap()) {
          sum += gap->mean;
          ++rows;
        }
      }
    }
    return rows > 0 ? std::optional(sum / rows) : std::nullopt;
  }

  Path folder_;
  const Experiment& base_;
  const PaperStudy& study_;
  const std::vector<StudyResult>& results_;
  ReportContents contents_;
  std::string picture_error_;
};

}  // namespace

WrittenFigures WriteStudyFigures(const std::filesystem::path& folder, const Experiment& base,
                                 const PaperStudy& study, const std::vector<StudyResult>& results) {
  return FigureWriter(folder, base, study, results).Write();
}

}  // namespace fresco
