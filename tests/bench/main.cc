// The program fresco-bench, which `fresco bench` becomes.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <thread>

#include "core/clock.h"
#include "core/command_line.h"
#include "core/error.h"
#include "core/files.h"
#include "core/installation.h"
#include "core/live_line.h"
#include "nn/arithmetic.h"
#include "nn/arithmetic_option.h"
#include "tests/bench/subjects.h"

namespace fresco {
namespace {

struct BenchArguments {
  std::string filter = ".*";
  std::string format = "text";
  std::vector<std::string> check;
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
          FRESCO_BENCH_COMPILER, kSourceCommit};
}

Results Measure(const std::vector<Subject>& subjects, const std::vector<std::string>& names, double seconds) {
  TimeLeft time_left;
  return MeasureRows(subjects, names, seconds, [&](const std::string& rows, size_t done, size_t all) {
    const std::string left =
        time_left.Report(static_cast<double>(done), static_cast<double>(all), MonotonicMicroseconds());
    spdlog::info("{} of {}: measuring {}{}{}", done + 1, all, rows, left.empty() ? "" : "; ", left);
  });
}

void Print(const BenchArguments& arguments, const Results& results) {
  const std::string text =
      arguments.format == "json" ? BenchJson(Head(), results) + "\n" : BenchTable(Head(), results);
  std::fputs(text.c_str(), stdout);
}

/// The file that was recorded on a processor as this one, with the same arithmetic; none if there is none.
std::optional<RecordedRatios> RecordedHere(const BenchArguments& arguments,
                                           const std::vector<Subject>& subjects) {
  const BenchHead here = Head();
  std::optional<RecordedRatios> found;
  std::string others;
  for (const std::string& file : arguments.check) {
    RecordedRatios recorded = ReadRecordedRatios(ReadFile(file), file, subjects);
    if (recorded.processor == here.processor && recorded.arithmetic == here.arithmetic) {
      found = std::move(recorded);
    } else {
      others += fmt::format("\n  {}, {}", recorded.processor, recorded.arithmetic);
    }
  }
  if (!found) {
    spdlog::warn("no ratio is checked: this is {}, {}; ratios are recorded of{}", here.processor,
                 here.arithmetic, others);
  }
  return found;
}

/// Fails if a recorded ratio has fallen. A row that has is measured again for longer: the machine may have
/// been busy.
int Check(const BenchArguments& arguments, const std::vector<Subject>& subjects) {
  constexpr double kPatience = 5;
  const auto recorded = RecordedHere(arguments, subjects);
  if (!recorded) {
    return 0;
  }
  std::vector<std::string> names = SelectRows(subjects, arguments.filter);
  std::erase_if(names, [&](const std::string& name) {
    return std::none_of(recorded->ratios.begin(), recorded->ratios.end(),
                        [&](const auto& entry) { return entry.first == name; });
  });
  const Results results = Measure(subjects, names, arguments.seconds);
  Print(arguments, results);
  names.clear();
  for (const FallenRow& row : FallenRows(*recorded, results)) {
    names.push_back(row.name);
    spdlog::warn("{}: {}; measuring it again", row.name, row.reason);
  }
  const std::vector<FallenRow> fallen =
      FallenRows(*recorded, Measure(subjects, names, kPatience * arguments.seconds));
  for (const FallenRow& row : fallen) {
    spdlog::error("{}: {}", row.name, row.reason);
  }
  return fallen.empty() ? 0 : 1;
}

int Bench(const BenchArguments& arguments) {
  const std::vector<Subject> subjects = AllSubjects();
  if (!arguments.check.empty()) {
    return Check(arguments, subjects);
  }
  Print(arguments, Measure(subjects, SelectRows(subjects, arguments.filter), arguments.seconds));
  return 0;
}

int Main(int argc, char** argv) {
  BenchArguments arguments;
  Program program(
      "fresco bench",
      "Measures how fast Fresco is. Each row is a quantity beside its roof, its peer or its limit, "
      "measured in turns in the same run.",
      LogStyle::kPlain, {kSourceCommit, CurrentArithmetic().name});
  CLI::App& app = program.command_line();
  app.add_option("--filter", arguments.filter,
                 "Measure the rows whose name has a match of this regular expression")
      ->type_name("REGEX");
  app.add_option("--seconds", arguments.seconds, "How long a row takes, about; some take longer")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  AddArithmeticOption(app);
  app.add_option("--format", arguments.format, "How the result is printed")->check(OneOf({"text", "json"}));
  app.add_option("--check", arguments.check,
                 "Files with what --format json printed. Measure only the rows of the file that is of this "
                 "processor; "
                 "exit with 1 if a ratio is below 80 % of the recorded one, or absent")
      ->type_name("FILE");
  app.footer("Exit status: 0 done, 1 the work failed or a ratio fell, 2 wrong use.");
  return program.Run(argc, argv, [&] { return Bench(arguments); });
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  return fresco::Main(argc, argv);
}
