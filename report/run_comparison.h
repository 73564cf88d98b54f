// Sets runs that have ended beside each other, for `fresco compare`: their results, what their configurations
// do not have in common, and means over runs that differ in the seed alone. One thread at a time may use an
// object.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report/run_report.h"

namespace fresco {

/// Numbers of a run's summary.
struct RunResult {
  std::optional<double> score;  ///< none: nothing was evaluated
  std::optional<double> gap_percent;
  std::optional<double> success;  ///< share of the episodes, 0 to 1
  int64_t updates = 0;
  double wall_s = 0;
  std::string weights_crc32c;
  bool completed = true;
};

struct ComparedRun {
  std::string name;
  std::shared_ptr<const FinishedRun> run;
  RunResult result;
  std::map<std::string, std::string> settings;  ///< FieldValues of the configuration
};

/// Runs in one kind of world.
class RunComparison {
 public:
  /// At least one run; all are of the same kind of world.
  explicit RunComparison(std::vector<ComparedRun> runs) : runs_(std::move(runs)) {}

  /// The kind of world: "cartpole".
  const std::string& world_name() const { return world().name; }

  /// Three tables; those without a row are left out. Results: a row for each run, with its score, gap,
  /// success, updates, time and weights. Seeds: a row for each group of at least two runs that differ in
  /// schedule.seed alone, with the mean of their scores and gaps and half the width of its 95 % interval.
  /// Runs that were interrupted or never succeeded are in no group. Settings: a row for each field of the
  /// configuration that is not the same in all runs.
  std::vector<ReportTable> Tables() const;

  /// The tables as text.
  std::string Text() const;
  /// The same as an object: `world`, `runs`, `seeds`, and `settings` by path.
  std::string Json() const;

  /// The best evaluation so far of every run over its updates. Has no curves if nothing was evaluated.
  LinePlot CurvesPlot() const;

  /// If all runs are of the same world, and it has a drawing: the same episode of each run's policy, and of
  /// what to compare them with. A policy that can't be read is left out with a warning.
  std::vector<ReportEpisode> Episodes() const;

  const World& first_world() const { return runs_.front().run->world(); }

 private:
  const WorldDescription& world() const { return first_world().description(); }
  ReportTable ResultTable() const;
  ReportTable SeedTable() const;
  ReportTable SettingTable() const;
  bool OneWorld() const;
  std::vector<std::string> DifferentFields() const;
  /// Runs, for each group of them that differ in the seed alone.
  std::vector<std::vector<const ComparedRun*>> SeedGroups() const;

  std::vector<ComparedRun> runs_;
};

/// Reads the runs in these folders and sets those of each kind of world beside each other. Leaves out, with a
/// warning, a folder whose run has not ended, and a folder that is named twice. Throws UsageError if no run
/// is left, or if a file is damaged.
std::vector<RunComparison> CompareRuns(const std::vector<std::filesystem::path>& folders);

/// Writes the tables, the curves, and the episodes of the first comparison that has some, to a page. Logs a
/// warning if gnuplot fails; the page then has no curves.
void WriteComparisonPage(const std::vector<RunComparison>& comparisons, const std::filesystem::path& file);

}  // namespace fresco
