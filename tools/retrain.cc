#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "bus/open_bus.h"
#include "core/error.h"
#include "core/help_formatter.h"
#include "learner/learner_process.h"
#include "logs/retrain_run.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "nn/arithmetic_option.h"
#include "nn/mlp.h"
#include "report/result_display.h"
#include "report/run_report.h"
#include "storage/policy.h"
#include "storage/run_folder.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct RetrainOptions {
  std::vector<std::string> logs;
  std::string run;
  std::string config;
  std::vector<std::string> settings;
  std::optional<uint64_t> seed;
  std::string start_from;
  std::string out;
  KeyFile key_file;
  bool strict = false;
  std::string format = "text";
};

/// The experiment of the recorded run, and the one to train.
struct Experiments {
  std::optional<Experiment> recorded;  // none if the log does not contain its whole configuration
  Experiment chosen;
  Retraining::Use use;
};

Settings SettingsFrom(const RetrainOptions& options) {
  Settings settings = ParseSettings(options.settings);
  if (options.seed) {
    settings.emplace_back("schedule.seed", std::to_string(*options.seed));
  }
  return settings;
}

void RefuseOtherWorld(const Experiment& recorded, const Experiment& chosen) {
  if (recorded.WorldText() != chosen.WorldText()) {
    throw UsageError(
        "the recorded run has another world than this configuration, so its episodes are not possible here; "
        "keep the world (without --config it is the recorded one) and change agent or schedule only");
  }
}

Experiments ChooseExperiments(const RetrainOptions& options, const LoggedRun& run) {
  std::optional<Experiment> recorded;
  if (run.config_text) {
    recorded = Experiment::Parse(*run.config_text, "the recorded configuration");
  } else if (options.config.empty()) {
    throw UsageError(
        "the log does not contain the whole configuration of its run (channel FRESCO_RUN); name it "
        "with --config");
  }
  Experiment chosen =
      options.config.empty()
          ? Experiment::Parse(*run.config_text, "the recorded configuration", SettingsFrom(options))
          : Experiment::Load(ExperimentPath(options.config), SettingsFrom(options));
  if (!options.start_from.empty()) {
    chosen = StartFrom(chosen, options.start_from);
  }
  chosen.FirstParameters();  // refuses a start that is missing
  if (chosen.hash() == run.identity.config_hash) {
    return {recorded, chosen, Retraining::Use::kSameRun};
  }
  if (!recorded) {
    throw UsageError(fmt::format(
        "{} (hash {:08x}) is not the configuration of the recorded run (hash {:08x}), and the log does not "
        "contain the whole of that; name the configuration that the run had with --config",
        options.config, chosen.hash(), run.identity.config_hash));
  }
  RefuseOtherWorld(*recorded, chosen);
  return {recorded, chosen, Retraining::Use::kExperience};
}

void WarnOfOtherArithmetic(const LoggedRun& run) {
  if (run.arithmetic_fingerprint && *run.arithmetic_fingerprint != ArithmeticFingerprint()) {
    spdlog::warn(
        "another build of Fresco recorded this run; its arithmetic gives other bits, so the weights will "
        "differ from the recorded ones");
  }
}

int Retrain(const RetrainOptions& options) {
  const std::filesystem::path folder =
      options.out.empty() ? NewRunFolder() : std::filesystem::path(options.out);
  RunFolder::CheckNew(folder);  // before the logs are read, which may take minutes
  LogSource source{{options.logs.begin(), options.logs.end()}};
  if (options.key_file) {
    source.key = ReadAuthenticationKey(*options.key_file);
  }
  const LoggedRun run = ChooseLoggedRun(FindLoggedRuns(source), options.run);
  ExpectMessagesOfThisRelease(run);
  const Experiments experiments = ChooseExperiments(options, run);
  RefuseIfTooLarge({LearnerMemory(experiments.chosen)}, ReadAvailableMemory());
  WarnOfOtherArithmetic(run);
  RetrainRun retrain_run(source, run, experiments.recorded ? *experiments.recorded : experiments.chosen,
                         experiments.chosen, experiments.use, options.strict);
  const bool text = options.format == "text";
  if (text) {
    fmt::print("{}results go to {}\n", BeginText(retrain_run.report()), folder.string());
    std::fflush(stdout);
  }
  const std::string summary = retrain_run.Train(folder);
  fmt::print("{}", text ? ResultTable(summary) + "\n" + EndText(retrain_run.report()) : summary + "\n");
  std::fflush(stdout);
  WriteRunReport(folder);
  return retrain_run.completed() && retrain_run.report().counts.different_versions == 0 ? 0 : 1;
}

}  // namespace

void AddRetrain(CLI::App& app, Command& command) {
  auto options = std::make_shared<RetrainOptions>();
  CLI::App* retrain = app.add_subcommand(
      "retrain",
      "Train from recorded LCM logs: the same weights again, or another agent on the same experience");
  retrain->add_option("log", options->logs, "Event logs of one run, in any order")->required();
  retrain->add_option("--config", options->config, ConfigHelp("the recorded one"))->type_name("EXPERIMENT");
  retrain->add_option("--set", options->settings, "Override one field: path=value; may be repeated")
      ->type_name("PATH=VALUE");
  retrain
      ->add_option("--start-from", options->start_from,
                   "The network with which a run began that had --start-from, or another one")
      ->type_name("POLICY");
  retrain->add_option("--seed", options->seed, "Seed of everything random, except the recorded flights");
  retrain
      ->add_option("--run", options->run,
                   "Id of the run in the log (16 hexadecimal digits); default: the only one")
      ->type_name("RUN_ID");
  AddKeyFileOption(*retrain, options->key_file);
  AddArithmeticOption(*retrain);
  retrain->add_flag("--strict", options->strict,
                    "Fail if the log misses an episode, instead of flying it again");
  retrain->add_option("--out", options->out, "Folder for the results; default: a new one under runs/")
      ->type_name("FOLDER");
  retrain->add_option("--format", options->format, "How the result is printed")
      ->check(OneOf({"text", "json"}));
  retrain->footer(
      HelpExamples({"fresco train --record --out runs/live", "fresco retrain runs/live/traffic.lcm",
                    "fresco retrain runs/live/traffic.lcm --set agent.learning_rate=0.0005"}));
  retrain->callback([options, &command] { command = [options] { return Retrain(*options); }; });
}

}  // namespace fresco
