// Benchmarks that stand beside a roof: the shortest time of each is kept, and shares of the roof are printed
// last.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace fresco {

/// The shortest seconds by the benchmark's name.
using BenchmarkSeconds = std::map<std::string, double>;

/// Prints the usual table.
class ShareReporter : public benchmark::ConsoleReporter {
 public:
  ShareReporter() : ConsoleReporter(OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration) {
        const double seconds = run.real_accumulated_time / static_cast<double>(run.iterations);
        const auto [found, is_new] = seconds_.try_emplace(run.run_name.function_name, seconds);
        found->second = std::min(found->second, seconds);
      }
    }
  }

  const BenchmarkSeconds& seconds() const { return seconds_; }

 private:
  BenchmarkSeconds seconds_;
};

/// The main function of such a program.
inline int RunBenchmarks(int argc, char** argv, void (*print_shares)(const BenchmarkSeconds&)) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  ShareReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  print_shares(reporter.seconds());
  return 0;
}

}  // namespace fresco
