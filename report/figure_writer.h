// Everything that a study writes once its runs are there: tables (CSV), pictures, the report. Used by one
// thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/paper_study.h"

namespace fresco {

struct WrittenFigures {
  /// Of DQN to the optimum, over all rows of the two figures of the paper that have a gap; none: no row has.
  std::optional<double> mean_gap_percent;
  int unproved_runs = 0;      ///< whose optimum is not proved, so that they have no gap
  std::string picture_error;  ///< why pictures are missing; empty: none is
};

/// Writes runs.csv, the figures `radius`, `sensors`, `energy`, `energy_dear_flight`, `learning_curve` and
/// `flight_<policy>`, each as CSV, SVG and PNG, and report.html into `folder`; the runs stand in
/// folder/runs. Where pictures can't be drawn all the numbers are written. Throws what file access throws.
WrittenFigures WriteStudyFigures(const std::filesystem::path& folder, const Experiment& base,
                                 const PaperStudy& study, const std::vector<StudyResult>& results);

}  // namespace fresco
