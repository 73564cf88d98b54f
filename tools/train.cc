#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "bus/open_bus.h"
#include "core/clock.h"
#include "core/command_line.h"
#include "core/help_formatter.h"
#include "core/installation.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "nn/arithmetic_option.h"
#include "processes/training_run.h"
#include "report/result_display.h"
#include "report/run_report.h"
#include "report/run_watch.h"
#include "storage/policy.h"
#include "storage/run_folder.h"
#include "storage/summary.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct TrainOptions {
  std::string config = kDefaultExperiment;
  std::vector<std::string> settings;
  std::optional<int> actors;
  std::optional<uint64_t> seed;
  std::string out;
  std::string start_from;
  std::string resume;
  std::string lcm_url;
  bool record = false;
  double record_split_mb = 0;
  BusOptions bus;
  std::string format = "text";
};

Settings SettingsFrom(const TrainOptions& options) {
  Settings settings = ParseSettings(options.settings);
  if (options.seed) {
    settings.emplace_back("schedule.seed", std::to_string(*options.seed));
  }
  if (options.actors) {
    settings.emplace_back("run.actors", std::to_string(*options.actors));
  }
  if (!options.lcm_url.empty()) {
    settings.emplace_back("run.lcm_url", options.lcm_url);
  }
  return settings;
}

/// Starts the run and watches it until it ends or the program is asked to stop. Returns the learner's exit
/// status.
int MindRun(TrainingRun& run, const Experiment& experiment) {
  constexpr int64_t kPollUs = 50'000;
  constexpr double kSilentS = 3;
  LiveLine line(true);
  TimeLeft time_left;
  const auto view =
      std::make_shared<RunWatch>(ChannelsWithPrefix(experiment.run().channel_prefix()), run.run_id());
  if (isatty(STDERR_FILENO) != 0) {
    for (const std::string& channel : view->NeededChannels()) {
      run.bus().Subscribe(channel, [view, channel](std::span<const std::byte> message) {
        view->Add({.channel = channel, .message = message}, MonotonicMicroseconds());
      });
    }
  }
  run.Start();
  while (!StopSignal::Requested() && run.Step(kPollUs)) {
    if (run.SilentSeconds() > kSilentS) {
      line.Show(fmt::format("no status from the learner for {:.0f} s", run.SilentSeconds()));
    } else if (run.status() && line.IsDue()) {
      const learner_status_t& status = *run.status();
      const int64_t now_us = MonotonicMicroseconds();
      const std::string left = time_left.Report(static_cast<double>(status.episodes),
                                                static_cast<double>(status.total_episodes), now_us);
      line.Show(line.on_terminal() ? view->Text(now_us)
                                   : ProgressLine(status, experiment.world().description()) +
                                         (left.empty() ? "" : " | " + left));
    }
  }
  return run.End();
}

void Announce(const Experiment& experiment, const std::filesystem::path& folder) {
  fmt::print("training over {} with {} local actors; results go to {}\n", experiment.run().lcm_url(),
             experiment.run().actors(), folder.string());
  std::fflush(stdout);
}

/// Says why a run is not complete; if the learner ended it, in the learner's own words.
std::string Interruption(const std::filesystem::path& folder) {
  return StopSignal::Requested()
             ? "the run was interrupted"
             : "the learner ended the run; its log ends with:" + LastLines(folder / "learner.log", 2) + "\n";
}

/// Runs a run that was checked already, and shows its results. Returns the exit status.
int Train(TrainingRun& run, const Experiment& experiment, const std::filesystem::path& folder,
          const TrainOptions& options) {
  const bool text = options.format == "text";
  if (options.record) {
    run.Record(options.record_split_mb);
  }
  const int status = MindRun(run, experiment);
  const std::string summary = run.Summary();
  fmt::print("{}", text ? ResultTable(summary) : summary);
  std::fflush(stdout);
  if (options.record) {
    fmt::print(text ? stdout : stderr, "{}{}\n", text ? "\n" : "", run.RecordingReport());
  }
  WriteRunReport(folder);  // after the results, so that a problem with a picture can't hide them
  if (status != 0) {
    fmt::print(stderr, "fresco: {}; what it learned so far is in {}\ncontinue it with: {}\n",
               Interruption(folder), folder.string(), run.ResumeCommand());
  } else if (!IsFinished(summary)) {
    fmt::print(stderr, "fresco: stopped; the training is complete, continue the search with: {}\n",
               run.ResumeCommand());
  } else if (text) {
    fmt::print("\nlook at it: {}\ntry it:     {} evaluate --policy {}\n", (folder / "report.html").string(),
               ProgramName(), folder.string());
  }
  return status == 0 ? 0 : 1;
}

int TrainAnew(const TrainOptions& options) {
  Experiment experiment = Experiment::Load(ExperimentPath(options.config), SettingsFrom(options));
  if (!options.start_from.empty()) {
    experiment = StartFrom(experiment, options.start_from);
  }
  const std::filesystem::path folder =
      options.out.empty() ? NewRunFolder() : std::filesystem::path(options.out);
  TrainingRun run(experiment, folder, options.bus);
  if (options.format == "text") {
    Announce(experiment, folder);
  }
  return Train(run, experiment, folder, options);
}

int GoOn(const TrainOptions& options) {
  const Resumption resumption = ReadInterruptedRun(options.resume, SettingsFrom(options));
  TrainingRun run(resumption, options.resume, options.bus);
  for (const UnusableCheckpoint& checkpoint : resumption.unusable) {  // the learner renames them
    spdlog::warn("{}; continuing from an earlier checkpoint", checkpoint.problem);
  }
  if (options.format == "text") {
    fmt::print("continuing after {} episodes; ",
               resumption.checkpoint ? resumption.checkpoint->training.progress.episodes : 0);
    Announce(resumption.experiment, options.resume);
  }
  return Train(run, resumption.experiment, options.resume, options);
}

}  // namespace

void AddTrain(CLI::App& app, Command& command) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* train =
      app.add_subcommand("train", "Train over LCM: one learner, several actors, and a table at the end");
  CLI::Option* config = train->add_option("--config", options->config, ConfigHelp())->type_name("EXPERIMENT");
  train->add_option("--set", options->settings, "Override one field: path=value; may be repeated")
      ->type_name("PATH=VALUE");
  train->add_option("--actors", options->actors, "Local actor processes; 0: wait for actors that join")
      ->check(CLI::Range(0, 1024));
  CLI::Option* seed = train->add_option("--seed", options->seed, "Seed of everything random");
  CLI::Option* out =
      train->add_option("--out", options->out, "Folder for the results; default: a new one under runs/")
          ->type_name("FOLDER");
  CLI::Option* start_from = train
                                ->add_option("--start-from", options->start_from,
                                             "Begin with the network of a policy (a run's folder, a network "
                                             "file or a checkpoint), not with a random one")
                                ->type_name("POLICY");
  train->add_option("--resume", options->resume, "Continue the run in this folder from its latest checkpoint")
      ->type_name("FOLDER")
      ->excludes(config)
      ->excludes(seed)
      ->excludes(start_from)
      ->excludes(out);
  train->add_option("--lcm-url", options->lcm_url, "Where learner and actors meet")->type_name("URL");
  CLI::Option* record = train->add_flag("--record", options->record, "Record all traffic to DIR/traffic.lcm");
  train
      ->add_option("--record-split-mb", options->record_split_mb,
                   "Split the recording into files of so many megabytes: traffic.lcm.00, traffic.lcm.01, ..")
      ->needs(record)
      ->check(CLI::Range(0.001, 1e9));
  AddBusOptions(*train, options->bus);
  AddArithmeticOption(*train);
  train->add_option("--format", options->format, "How the result is printed")->check(OneOf({"text", "json"}));
  train->footer(HelpExamples(
      {"fresco train                                  # the paper's UAV, a minute or two",
       "fresco train --config cartpole --seed 2",
       "fresco train --set agent.hidden_layers=128,128 --set schedule.episodes=5000",
       "fresco train --resume runs/NAME               # goes on after Ctrl-C or a crash",
       "fresco train --actors 0 --lcm-url 'udpm://239.255.76.67:7667?ttl=1'   # actors on other hosts"}));
  train->callback([options, &command] {
    command = [options] { return options->resume.empty() ? TrainAnew(*options) : GoOn(*options); };
  });
}

}  // namespace fresco
