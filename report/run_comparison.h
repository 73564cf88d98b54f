// Sets runs that have ended beside each other, for `fresco compare`: their results, what their configurations
// do not have in common, and means over runs that differ in the seed alone. One thread at a time may use an
// object.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "report/run_report.h"

namespace fresco {

class RunComparison {
 public:
  /// Reads the runs in these folders, at least one. Throws UsageError if a folder holds no run that has
  /// ended, or if the runs are not judged by the same figure.
  explicit RunComparison(const std::vector<std::filesystem::path>& folders);

  /// Three tables; those without a row are left out. Results: a row for each run, with its score, gap,
  /// success, updates, time and weights. Seeds: a row for each group of at least two runs that differ in
  /// schedule.seed alone, with the mean of their scores and gaps and half the width of its 95 % interval.
  /// Settings: a row for each field of the configuration that is not the same in all runs.
  std::vector<ReportTable> Tables() const;

  /// The tables as text.
  std::string Text() const;
  /// The same as an object: `runs`, `seeds`, and `settings` by path.
  std::string Json() const;

  /// The best evaluation so far of every run over its updates. Has no curves if nothing was evaluated.
  LinePlot CurvesPlot() const;

  /// Writes the tables, the curves and, if all runs are of the same world and it has a drawing, the episodes
  /// to a page. Logs a warning if gnuplot fails; the page then has no curves.
  void WritePage(const std::filesystem::path& file) const;

 private:
  struct ComparedRun {
    std::string name;
    std::unique_ptr<FinishedRun> run;
    std::map<std::string, std::string> settings;  // FieldValues of the configuration
  };

  const WorldDescription& world() const { return runs_.front().run->world().description(); }
  ReportTable ResultTable() const;
  ReportTable SeedTable() const;
  ReportTable SettingTable() const;
  bool OneWorld() const;
  std::vector<std::string> DifferentFields() const;
  /// Indices of runs, for each group of them that differ in the seed alone.
  std::vector<std::vector<size_t>> SeedGroups() const;

  std::vector<ComparedRun> runs_;
};

}  // namespace fresco
