// Writes the results of a study after its runs: tables (CSV), pictures, the report. Any thread may call it,
// but only one at a time for a folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "paper/paper_study.h"

namespace fresco {

struct WrittenFigures {
  /// The mean gap between DQN and the optimum, over the rows of the paper's two figures that have a gap; none
  /// if no row has one.
  std::optional<double> mean_gap_percent;
  int unproved_runs = 0;      ///< runs without a gap, since their optimum is not proved
  std::string picture_error;  ///< why pictures are missing; empty if none is missing
};

/// Writes runs.csv, the figures `radius`, `sensors`, `energy`, `energy_dear_flight`, `learning_curve` and
/// `flight_<policy>`, each as CSV, SVG and PNG, and report.html to `folder`. The runs are in folder/runs. If
/// pictures can't be drawn, writes all other files and sets picture_error. Throws Failure if a file can't be
/// read or written.
WrittenFigures WriteStudyFigures(const std::filesystem::path& folder, const Experiment& base,
                                 const PaperStudy& study, const std::vector<StudyResult>& results);

}  // namespace fresco
