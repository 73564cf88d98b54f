// Lists the runs that the figures need. The paper's two figures show the average AoI against the coverage
// radius R (at N = 3) and against the number of sensors N (at R = 4 cells), over several random deployments.
// Further figures show it against the energy budget, and the learning curve and the flight of one run. Pure
// functions; any thread may call them.
#pragma once

#include <string>
#include <vector>

#include "paper/study.h"

namespace fresco {

struct StudyScope {
  std::vector<int> radii_cells = {1, 2, 3, 4, 5, 6};  ///< each with sensors_at_radii sensors
  int sensors_at_radii = 3;
  std::vector<int> sensor_counts = {1, 2, 3, 4, 5, 6, 7, 8};  ///< each with radius_at_counts_cells
  int radius_at_counts_cells = 4;
  int deployments = 3;  ///< deployment d has random_sensors.seed d = 1, 2, ...
  /// The energy budgets, as shares for BudgetOfShare.
  std::vector<double> budget_shares = {0, 0.25, 0.5, 1};
};

/// The figure that a point of the study belongs to.
enum class Figure {
  kField,            ///< learning curve and flights; one point, the base experiment itself
  kRadius,           ///< x is R in cells
  kSensors,          ///< x is N
  kEnergy,           ///< x is the energy budget in joules, with the base experiment's rotor
  kEnergyDearFlight  ///< the same with a rotor that takes more power flying than hovering
};

struct StudyPoint {
  Figure figure = Figure::kField;
  double x = 0;
  int deployment = 0;  ///< 1, 2, ..; 0: the sensors of the base experiment
  size_t job = 0;      ///< index of the run in PaperStudy::jobs; points of several figures may share a run
};

struct PaperStudy {
  std::vector<StudyJob> jobs;
  std::vector<StudyPoint> points;
};

/// Lists the runs. `base` decides the grid, the agent and the schedule. Throws UsageError if its world is not
/// the UAV's.
PaperStudy MakePaperStudy(const Experiment& base, const StudyScope& scope);

/// Returns `base` with another energy budget and with the rotor of the figure.
Experiment WithBudget(const Experiment& base, Figure figure, double budget_j);

/// Returns an energy budget in joules, rounded up to a whole number, for `base` with the figure's rotor.
/// Share 0 is the least energy with which a flight can arrive, share 1 the most that a flight can use; others
/// lie between in proportion.
double BudgetOfShare(const Experiment& base, Figure figure, double share);

}  // namespace fresco
