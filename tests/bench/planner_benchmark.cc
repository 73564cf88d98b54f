// The exact planner to the proof of its optimum: seconds, labels kept and peak resident memory on random
// deployments over Table I's grid, by sensors, coverage radius in cells and the deployment's seed.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <fstream>
#include <string>

#include "planner/planner.h"
#include "tests/worlds/table_one.h"

namespace fresco {
namespace {

Scenario RandomDeployment(const benchmark::State& state) {
  Scenario scenario = TableOne();
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m,
                                   static_cast<int>(state.range(0)), static_cast<uint64_t>(state.range(2)));
  scenario.coverage_radius_m = static_cast<double>(state.range(1)) * scenario.cell_m;
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

void PlanToTheEnd(benchmark::State& state) {
  const UavWorld world(RandomDeployment(state));
  Plan plan;
  ForgetPeakMemory();
  for (auto _ : state) {
    plan = PlanOptimally(world);
  }
  if (!plan.optimal) {
    state.SkipWithError("the optimum was not proved within the memory allowed");
  }
  state.counters["labels"] = static_cast<double>(plan.labels);
  state.counters["peak_memory"] =
      benchmark::Counter(PeakMemoryBytes(), benchmark::Counter::kDefaults, benchmark::Counter::kIs1024);
  state.counters["total_aoi"] = plan.lower_bound_total_aoi;
}

BENCHMARK(PlanToTheEnd)
    ->ArgNames({"sensors", "radius", "seed"})
    ->ArgsProduct({{3, 8}, {4}, {1, 2, 3}})
    ->Args({8, 6, 2})
    ->Unit(benchmark::kSecond)
    ->Iterations(1);

}  // namespace
}  // namespace fresco

BENCHMARK_MAIN();
