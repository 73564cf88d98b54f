// The runs behind the figures: the paper's two (average AoI against the coverage radius R at N = 3, and
// against the number of sensors N at R = 4 cells) over several random deployments, and beyond the paper
// the energy budget and one run's learning curve and flight. Pure; any thread.
#pragma once

#include <string>
#include <vector>

#include "report/study.h"

namespace fresco {

struct StudyScope {
  std::vector<int> radii_cells = {1, 2, 3, 4, 5, 6};  ///< at sensors_at_radii
  int sensors_at_radii = 3;
  std::vector<int> sensor_counts = {1, 2, 3, 4, 5, 6, 7, 8};  ///< at radius_at_counts_cells
  int radius_at_counts_cells = 4;
  int deployments = 3;  ///< random_sensors.seed 1, 2, ...
  /// Budgets as shares of the way from the least energy that any flight needs to the most it can use.
  std::vector<double> budget_shares = {0, 0.25, 0.5, 1};
};

/// What a point of the study belongs to.
enum class Figure {
  kField,            ///< one point: the base experiment as it is
  kRadius,           ///< x: R in cells
  kSensors,          ///< x: N
  kEnergy,           ///< x: energy budget in joules; the base experiment's rotor
  kEnergyDearFlight  ///< the same with a rotor that flies dearer than it hovers
};

struct StudyPoint {
  Figure figure = Figure::kField;
  double x = 0;
  int deployment = 0;  ///< 1, 2, ..; 0: the base experiment's own sensors
  size_t job = 0;      ///< points of several figures may be the same run
};

struct PaperStudy {
  std::vector<StudyJob> jobs;
  std::vector<StudyPoint> points;
};

/// `base` gives the field, the agent and the schedule.
PaperStudy MakePaperStudy(const Experiment& base, const StudyScope& scope);

/// `base` with another energy budget, and with the rotor of the figure.
Experiment WithBudget(const Experiment& base, Figure figure, double budget_j);

/// The budget that is `share` of the way from the least energy that any flight of `base` with the
/// figure's rotor needs (0) to the most that one can use (1), in joules, rounded up to a whole number.
double BudgetOfShare(const Experiment& base, Figure figure, double share);

}  // namespace fresco
