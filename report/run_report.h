// What a run's folder tells once the run is over: its learning curve, its flight beside the others, and
// the page that shows both. Used by one thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "msgs/experiment.h"
#include "report/learning_curve.h"
#include "report/report.h"

namespace fresco {

/// A run as it stands in its folder. Not movable: the flights are in its world.
class FinishedRun {
 public:
  /// Throws UsageError where the folder holds no run that has ended.
  explicit FinishedRun(const std::filesystem::path& folder);
  FinishedRun(const FinishedRun&) = delete;
  FinishedRun& operator=(const FinishedRun&) = delete;

  const Experiment& experiment() const { return experiment_; }
  const World& world() const { return world_; }
  /// summary.json's text.
  const std::string& summary() const { return summary_; }
  /// The run's best evaluated policy first where there is one, the optimum (or the best flight that the
  /// search found) where it was searched for, both baselines.
  const std::vector<ReportFlight>& flights() const { return flights_; }
  /// Has no points where nothing was evaluated.
  const LearningCurve& learning_curve() const { return learning_curve_; }

 private:
  void TakeFlights(const std::filesystem::path& folder);
  void TakeLearningCurve(const std::filesystem::path& folder);

  Experiment experiment_;
  World world_;
  std::string summary_;
  std::vector<ReportFlight> flights_;
  LearningCurve learning_curve_;
};

/// Draws a figure as `<stem>.svg` and `<stem>.png` and takes it into a report.
ReportFigure WriteFigure(const Picture& picture, const std::filesystem::path& stem, const std::string& title,
                         const std::string& caption);

/// The table of a run's policies, from its summary.
ReportTable PolicyTable(const std::string& summary_json);

/// Writes report.html, and the learning curve as SVG and PNG, into a run's folder. Without gnuplot the
/// page has no curve, and a warning says so.
void WriteRunReport(const std::filesystem::path& folder);

}  // namespace fresco
