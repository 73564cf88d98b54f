// Reads the folder of a run that has ended and writes its report: the learning curve and, if the world has a
// drawing (drawings.h), the run's episode beside those of the reference policies and the optimum. Only one
// thread at a time may use a folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msgs/experiment.h"
#include "report/line_plot.h"
#include "report/report.h"

namespace fresco {

/// The result of the evaluation of one version.
struct LearningPoint {
  int64_t updates = 0;  ///< updates made when the version was made
  double score = 0;     ///< in the unit of the world's first figure
  double success = 0;   ///< share of its episodes that succeeded
};

struct LearningCurve {
  std::string title;
  WorldDescription world{};
  std::vector<LearningPoint> points{};    ///< at least one, sorted by updates
  std::optional<double> optimum_score{};  ///< of the same world, > 0; none if not proved
};

/// The plot shows evaluations as dots, the best of them so far as a line, and the optimum as a horizontal
/// line, with the gap to it on the right axis. In a world without chance, an evaluation that did not succeed
/// is a mark at the top.
LinePlot LearningCurvePlot(const LearningCurve& curve);

/// The plot shows the best evaluation so far of several runs, which are judged by the same figure, as a line
/// each, named by its title. If all of them have the same optimum, it is a horizontal line. Curves without
/// points are left out.
LinePlot BestSoFarPlot(const std::vector<LearningCurve>& curves);

/// A run that was read from its folder.
class FinishedRun {
 public:
  /// Why the folder does not hold a run that has ended; empty if it does.
  static std::string WhyNone(const std::filesystem::path& folder);

  /// Throws UsageError if the folder does not hold a run that has ended, or if a file is damaged.
  explicit FinishedRun(const std::filesystem::path& folder);
  FinishedRun(const FinishedRun&) = delete;
  FinishedRun& operator=(const FinishedRun&) = delete;

  const Experiment& experiment() const { return experiment_; }
  const World& world() const { return experiment_.world(); }
  /// The text of summary.json.
  const std::string& summary() const { return summary_; }
  /// The seed of an episode that is worth showing. In a world without chance, one episode tells everything
  /// about a policy. In one with chance, it is the first seed that judges the delivered version, if
  /// schedule.fixed_evaluation_episodes is set; otherwise there is none.
  std::optional<uint64_t> ShownSeed() const;
  /// The episode of a seed as the run's best evaluated policy acts in it; none if nothing was evaluated. Runs
  /// the code of the world, of a plug-in too.
  std::optional<Episode> FlyBest(uint64_t seed) const;
  /// What to compare it with: the episodes of the optimum or the best that the search found (if there was a
  /// search of this episode), and of the reference policies.
  std::vector<ReportEpisode> FlyReferences(uint64_t seed) const;
  /// FlyBest and FlyReferences of the shown seed.
  std::vector<ReportEpisode> FlyEpisodes() const;
  /// Has no points if nothing was evaluated.
  const LearningCurve& learning_curve() const { return learning_curve_; }

 private:
  void ReadLearningCurve();

  std::filesystem::path folder_;
  Experiment experiment_;
  std::string summary_;
  LearningCurve learning_curve_;
};

/// Writes a figure as `<stem>.svg` and `<stem>.png`, and returns it for a report. Throws as WritePicture
/// does.
ReportFigure WriteFigure(const Picture& picture, const std::filesystem::path& stem, const std::string& title,
                         const std::string& caption);

/// Returns the table of a run's policies (PolicyRows in result_display.h) for a report.
ReportTable PolicyTable(const std::string& summary_json);

/// The plot shows the gaps of the judged episodes of a summary (JudgementJson in storage/judgement.h) that
/// have one, sorted, for this run and for the better baseline of each episode. At least one episode must have
/// a gap.
LinePlot GapPlot(const std::string& summary_json);

/// Writes report.html, and its figures as SVG and PNG, to a run's folder. If gnuplot is missing or
/// fails, the page has no curve, and a warning is logged.
void WriteRunReport(const std::filesystem::path& folder);

}  // namespace fresco
