// The exact planner to the proof of its optimum, on random deployments over Table I's grid: processor
// seconds, peak resident memory and labels. Nothing else solves this problem, so seconds and memory stand
// beside the targets of the project, and the labels, which do not depend on how busy the machine is, beside
// an earlier commit's.
#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "core/clock.h"
#include "core/error.h"
#include "planner/planner.h"
#include "tests/bench/subjects.h"
#include "tests/worlds/table_one.h"

namespace fresco {
namespace {

struct Deployment {
  int sensors;
  int radius_cells;
  uint64_t seed;
};

Scenario ScenarioOf(const Deployment& deployment) {
  Scenario scenario = TableOne();
  scenario.sensors =
      RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, deployment.sensors, deployment.seed);
  scenario.coverage_radius_m = deployment.radius_cells * scenario.cell_m;
  return scenario;
}

/// From here on the peak is counted anew (Linux: see proc(5), clear_refs).
void ForgetPeakMemory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double PeakMemoryBytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) {
      return std::stod(line.substr(6)) * 1024;
    }
  }
  return 0;
}

struct PlannerFigures {
  double longest_s = 0;
  double labels = 0;  // of all deployments
  double peak_bytes = 0;
};

PlannerFigures PlanToTheEnd(const std::vector<Deployment>& deployments) {
  PlannerFigures figures;
  for (const Deployment& deployment : deployments) {
    const UavWorld world(ScenarioOf(deployment));
    ForgetPeakMemory();
    const int64_t begin_us = ThreadProcessorMicroseconds();
    const Plan plan = PlanOptimally(world, 0);
    if (!plan.optimal) {
      throw Failure("the planner did not prove an optimum within the memory allowed");
    }
    figures.longest_s =
        std::max(figures.longest_s, 1e-6 * static_cast<double>(ThreadProcessorMicroseconds() - begin_us));
    figures.labels += static_cast<double>(plan.labels);
    figures.peak_bytes = std::max(figures.peak_bytes, PeakMemoryBytes());
  }
  return figures;
}

/// How long it takes does not depend on the time that a row shall take.
Results PlannerRows(double) {
  constexpr double kLabelsAt1277a4e = 2'990'829;
  const PlannerFigures three = PlanToTheEnd({{3, 4, 1}, {3, 4, 2}, {3, 4, 3}});
  const PlannerFigures eight = PlanToTheEnd({{8, 4, 1}, {8, 4, 2}, {8, 4, 3}});
  const PlannerFigures large = PlanToTheEnd({{8, 6, 2}});
  const double peak_bytes = std::max({three.peak_bytes, eight.peak_bytes, large.peak_bytes});
  return {{LessIsBetter("planner_3_sensors_s", three.longest_s, "s",
                        "the target; the longest of three fields", 2),
           LessIsBetter("planner_8_sensors_s", eight.longest_s, "s",
                        "the target; the longest of three fields", 15),
           LessIsBetter("planner_8_sensors_large_s", large.longest_s, "s",
                        "the target; one field with a radius of six cells", 15),
           LessIsBetter("planner_memory_mb", peak_bytes * 1e-6, "MB", "the target; the most of these fields",
                        3000),
           LessIsBetter("planner_labels", three.labels + eight.labels + large.labels, "labels",
                        "at commit 1277a4e; the sum over these fields", kLabelsAt1277a4e)},
          {}};
}

}  // namespace

std::vector<Subject> PlannerSubjects() {
  return {{{"planner_3_sensors_s", "planner_8_sensors_s", "planner_8_sensors_large_s", "planner_memory_mb",
            "planner_labels"},
           PlannerRows}};
}

}  // namespace fresco
