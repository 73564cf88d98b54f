// The subcommand `fresco figures`: draws the paper's figures, with the exact optimum beside every point, and
// more.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <thread>

#include "bus/open_bus.h"
#include "core/error.h"
#include "core/files.h"
#include "core/help_formatter.h"
#include "core/installation.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "nn/arithmetic_option.h"
#include "paper/figure_writer.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

struct FiguresOptions {
  std::string out;
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> deployments;
  int parallel = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::string lcm_url;
  BusOptions bus;
  bool quick = false;
};

StudyScope ScopeOf(const FiguresOptions& options) {
  StudyScope scope;
  if (options.quick) {
    scope.radii_cells = {2, 4};
    scope.sensors_at_radii = 2;
    scope.sensor_counts = {1, 2};
    scope.deployments = 2;
    scope.budget_shares = {0, 1};
  }
  scope.deployments = options.deployments.value_or(scope.deployments);
  return scope;
}

/// The experiment that all runs of the study derive from. Each run has one actor, which is much faster than
/// the learner. The search for the optimum may take an hour, unless the options say otherwise.
Experiment BaseExperiment(const FiguresOptions& options) {
  Settings settings = {{"run.optimum_limit_s", "3600"}};
  const Settings given = ParseSettings(options.settings);
  settings.insert(settings.end(), given.begin(), given.end());
  settings.emplace_back("run.actors", "1");
  if (!options.lcm_url.empty()) {
    settings.emplace_back("run.lcm_url", options.lcm_url);
  }
  const std::string usual = options.quick ? "ci" : kDefaultExperiment;
  return Experiment::Load(ExperimentPath(options.config.empty() ? usual : options.config), settings);
}

std::string MeanGapText(const WrittenFigures& written) {
  const std::string gap =
      written.mean_gap_percent ? fmt::format("{:.2f} %", *written.mean_gap_percent) : "not known";
  return written.unproved_runs == 0
             ? gap
             : fmt::format("{} (without {} runs whose optimum is not proved)", gap, written.unproved_runs);
}

int WriteFigures(const FiguresOptions& options) {
  const Experiment base = BaseExperiment(options);
  const PaperStudy study = MakePaperStudy(base, ScopeOf(options));
  const Path folder(options.out);
  CheckOutputFolder(folder);
  CheckOutputFolder(folder / "runs");
  RequireProgram("gnuplot", "gnuplot-nox");
  const std::vector<StudyResult> results =
      RunStudy(study.jobs, {folder / "runs", options.parallel, options.bus});
  const WrittenFigures written = WriteStudyFigures(folder, base, study, results);
  fmt::print("mean gap between DQN and the optimum over the points of the paper's two figures: {}\n",
             MeanGapText(written));
  if (!written.picture_error.empty()) {
    throw Failure("the numbers are in " + folder.string() +
                  ", but some pictures could not be drawn: " + written.picture_error);
  }
  fmt::print("figures, tables and report.html are in {}\n", folder.string());
  return 0;
}

}  // namespace

void AddFigures(CLI::App& app, Command& command) {
  auto options = std::make_shared<FiguresOptions>();
  CLI::App* figures = app.add_subcommand(
      "figures", "Reproduce the paper's figures with the exact optimum beside every point: CSV, SVG, PNG");
  figures
      ->add_option("--out", options->out,
                   "Folder for figures and runs; a study that was stopped there continues")
      ->type_name("FOLDER")
      ->required();
  figures
      ->add_option("--config", options->config,
                   ConfigHelp(std::string(kDefaultExperiment) + "; with --quick: ci"))
      ->type_name("EXPERIMENT");
  figures->add_option("--set", options->settings, "Override one field: path=value; may be repeated")
      ->type_name("PATH=VALUE");
  figures->add_option("--deployments", options->deployments, "Random deployments for each point; default: 3")
      ->check(CLI::Range(1, 1000));
  figures->add_option("--parallel", options->parallel, "Runs side by side; default: one for each processor")
      ->check(CLI::Range(1, 256));
  figures->add_option("--lcm-url", options->lcm_url, "Where learners and actors meet")->type_name("URL");
  AddBusOptions(*figures, options->bus);
  AddArithmeticOption(*figures);
  figures->add_flag("--quick", options->quick, "A small version: few points, short training");
  figures->footer(
      HelpExamples({"fresco figures --out figures                  # 48 runs, 45 minutes on two cores",
                    "fresco figures --out figures --quick          # half a minute"}));
  figures->callback([options, &command] { command = [options] { return WriteFigures(*options); }; });
}

}  // namespace fresco
