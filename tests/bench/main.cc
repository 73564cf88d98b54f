// The program fresco-bench, which `fresco bench` becomes.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <fstream>
#include <thread>

#include "bench_commit.h"
#include "core/command_line.h"
#include "core/error.h"
#include "core/files.h"
#include "nn/arithmetic.h"
#include "nn/arithmetic_option.h"
#include "tests/bench/subjects.h"

namespace fresco {
namespace {

struct BenchArguments {
  std::string filter = ".*";
  std::string format = "text";
  std::string check;
  double seconds = 2;
};

std::vector<Subject> AllSubjects() {
  std::vector<Subject> all;
  for (const auto& subjects : {UpdateSubjects, EnvironmentSubjects, ActorSubjects, BusSubjects,
                               TrainingSubjects, LogSubjects, PlannerSubjects, GrowthSubjects}) {
    for (const Subject& subject : subjects()) {
      all.push_back(subject);
    }
  }
  return all;
}

std::string ProcessorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) {
      return line.substr(line.find(':') + 2);
    }
  }
  return "unknown";
}

BenchHead Head() {
  return {ProcessorName(), static_cast<int>(std::thread::hardware_concurrency()), CurrentArithmetic().name,
          FRESCO_BENCH_COMPILER, FRESCO_BENCH_COMMIT};
}

std::vector<std::string> RowsToMeasure(const std::vector<Subject>& subjects, const BenchArguments& arguments,
                                       const std::vector<std::pair<std::string, double>>& recorded) {
  std::vector<std::string> names = SelectRows(subjects, arguments.filter);
  if (!arguments.check.empty()) {
    std::erase_if(names, [&](const std::string& name) {
      return std::none_of(recorded.begin(), recorded.end(),
                          [&](const auto& entry) { return entry.first == name; });
    });
  }
  return names;
}

int Bench(const BenchArguments& arguments) {
  const std::vector<Subject> subjects = AllSubjects();
  std::vector<std::pair<std::string, double>> recorded;
  if (!arguments.check.empty()) {
    recorded = ReadRecordedRatios(ReadFile(arguments.check), arguments.check, subjects);
  }
  const Results results =
      MeasureRows(subjects, RowsToMeasure(subjects, arguments, recorded), arguments.seconds,
                  [](const std::string& names) { spdlog::info("measuring {}", names); });
  const std::string text =
      arguments.format == "json" ? BenchJson(Head(), results) + "\n" : BenchTable(Head(), results);
  std::fputs(text.c_str(), stdout);
  const std::vector<std::string> fallen = FallenRows(recorded, results);
  for (const std::string& line : fallen) {
    spdlog::error("{}", line);
  }
  return fallen.empty() ? 0 : 1;
}

int Main(int argc, char** argv) {
  BenchArguments arguments;
  Program program(
      "fresco bench",
      "Measures how fast Fresco is. Each row is a quantity beside its roof, its peer or its limit, "
      "measured in turns in the same run.",
      LogStyle::kPlain);
  CLI::App& app = program.command_line();
  app.add_option("--filter", arguments.filter,
                 "Measure the rows whose name has a match of this regular expression");
  app.add_option("--seconds", arguments.seconds, "How long a row takes, about; some take longer")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  AddArithmeticOption(app);
  app.add_option("--format", arguments.format, "text or json")->check(OneOf({"text", "json"}));
  app.add_option(
      "--check", arguments.check,
      "Measure only rows with a ratio in this file, {\"name\": ratio, ...}; exit with 1 if one is below "
      "80 % of that, or absent");
  app.footer("Exit status: 0 done, 1 the work failed or a ratio fell, 2 wrong use.");
  return program.Run(argc, argv, [&] { return Bench(arguments); });
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  return fresco::Main(argc, argv);
}
