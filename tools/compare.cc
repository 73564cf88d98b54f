// The subcommand `fresco compare`: sets runs beside each other.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/files.h"
#include "core/help_formatter.h"
#include "report/run_comparison.h"
#include "storage/run_folder.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct CompareOptions {
  std::vector<std::string> runs;
  std::string out;
  std::string format = "text";
};

int Compare(const CompareOptions& options) {
  std::filesystem::path folder;  // of the page
  if (!options.out.empty()) {
    folder = std::filesystem::absolute(options.out).parent_path();
    CheckOutputFolder(folder);
  }
  const std::vector<RunComparison> comparisons = CompareRuns({options.runs.begin(), options.runs.end()});
  std::string text;
  for (const RunComparison& comparison : comparisons) {
    const bool first = &comparison == &comparisons.front();
    if (options.format == "json") {
      text += (first ? "[" : ",\n") + comparison.Json();
    } else {
      const std::string heading = comparisons.size() > 1 ? comparison.world_name() + "\n" : "";
      text += (first ? "" : "\n") + heading + comparison.Text();
    }
  }
  fmt::print("{}{}", text, options.format == "json" ? "]\n" : "");
  std::fflush(stdout);  // a problem with the page can't hide it
  if (!options.out.empty()) {
    RunFolder::Make(folder);
    WriteComparisonPage(comparisons, options.out);
    if (options.format == "text") {
      fmt::print("\nthe page with curves and flights is {}\n", options.out);
    }
  }
  return 0;
}

}  // namespace

void AddCompare(CLI::App& app, Command& command) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* compare = app.add_subcommand(
      "compare", "Set runs beside each other: results, settings that differ, means over seeds, curves");
  compare->add_option("RUN", options->runs, "Folders of runs that have ended")->required();
  compare->add_option("--out", options->out, "Also write a page (HTML) with curves and flights")
      ->type_name("FILE");
  compare->add_option("--format", options->format, "How the result is printed")
      ->check(OneOf({"text", "json"}));
  compare->footer(HelpExamples({"fresco compare runs/A runs/B", "fresco compare runs/* --out compare.html"}));
  compare->callback([options, &command] { command = [options] { return Compare(*options); }; });
}

}  // namespace fresco
