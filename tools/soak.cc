#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "bus/open_bus.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/help_formatter.h"
#include "core/installation.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "nn/arithmetic_option.h"
#include "processes/training_run.h"
#include "soak/soak_report.h"
#include "soak/soak_round.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

struct SoakOptions {
  double minutes = 5;
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> actors;
  uint64_t seed = 1;
  int first_round = 1;
  int rounds = 0;  ///< the most rounds; 0: as many as fit into the time
  std::string out;
  std::string lcm_url;
  KeyFile key_file;  ///< for every round
  int memory_allowance_mib = 8;
  std::string format = "text";
};

/// Returns the experiment of every run. Without --set, it trains for some seconds, does not search for the
/// optimum, and takes checkpoints so often that a resumed learner repeats little. Throws UsageError if it has
/// no local actor.
Experiment SoakExperiment(const SoakOptions& options) {
  Settings settings = {{"run.optimum_limit_s", "0"}, {"run.checkpoint_interval_s", "0.5"}};
  if (options.config.empty()) {
    settings.emplace_back("schedule.episodes", "2000");
  }
  const Settings given = ParseSettings(options.settings);
  settings.insert(settings.end(), given.begin(), given.end());
  if (options.actors) {
    settings.emplace_back("run.actors", std::to_string(*options.actors));
  }
  if (!options.lcm_url.empty()) {
    settings.emplace_back("run.lcm_url", options.lcm_url);
  }
  Experiment experiment =
      Experiment::Load(ExperimentPath(options.config.empty() ? "ci" : options.config), settings);
  if (experiment.run().actors() < 1) {
    throw UsageError("run.actors: a soak kills and stops its own actors; expected at least 1, found 0");
  }
  return experiment;
}

std::string QuotedForShell(const std::string& argument) {
  return "'" + argument + "'";
}

/// Returns the command that repeats this round.
std::string RepeatCommand(const SoakOptions& options, int round) {
  std::string command =
      fmt::format("{} soak --seed {} --first-round {} --rounds 1", ProgramName(), options.seed, round);
  if (!options.config.empty()) {
    command += " --config " + QuotedForShell(options.config);
  }
  for (const std::string& setting : options.settings) {
    command += " --set " + QuotedForShell(setting);
  }
  if (options.actors) {
    command += fmt::format(" --actors {}", *options.actors);
  }
  if (!options.lcm_url.empty()) {
    command += " --lcm-url " + QuotedForShell(options.lcm_url);
  }
  if (options.key_file) {
    command += " --key-file " + QuotedForShell(options.key_file->string());
  }
  if (options.memory_allowance_mib != SoakOptions().memory_allowance_mib) {
    command += fmt::format(" --memory-allowance-mib {}", options.memory_allowance_mib);
  }
  return command;
}

class Soak {
 public:
  explicit Soak(const SoakOptions& options)
      : options_(options), experiment_(SoakExperiment(options)), line_(true) {
    report_.seed = options.seed;
    report_.folder = std::filesystem::absolute(
        options.out.empty() ? Path("runs") / fmt::format("soak-{}-{}", options.seed, getpid())
                            : Path(options.out));
    if (std::filesystem::exists(report_.folder) && !std::filesystem::is_empty(report_.folder)) {
      throw UsageError(fmt::format("--out: {} is not empty; name a new folder for this soak's runs",
                                   report_.folder.string()));
    }
    CheckOutputFolder(report_.folder);
    CheckRunAndBus(experiment_, {options.key_file});  // so that wrong use does not count as a failed round
  }

  SoakReport Run() {
    RunUndisturbed();
    for (int round = options_.first_round; GoesOn(round); ++round) {
      RunDisturbed(round);
    }
    report_.interrupted = StopSignal::Requested();
    CheckWhatIsLeft();
    report_.wall_s = ElapsedSeconds();
    return std::move(report_);
  }

 private:
  double ElapsedSeconds() const { return 1e-6 * static_cast<double>(MonotonicMicroseconds() - begin_us_); }
  double LeftSeconds() const { return 60 * options_.minutes - ElapsedSeconds(); }

  void RunUndisturbed() {
    const RoundOptions options = {experiment_, report_.folder / "undisturbed", {},
                                  0,           60 * options_.minutes,          options_.key_file};
    report_.undisturbed = RunRound(options, Progress("the undisturbed run"));
    report_.failures = report_.undisturbed.failures;
    for (std::string& failure : report_.failures) {
      failure =
          "the undisturbed run (if it only takes long, give more --minutes or fewer episodes): " + failure;
    }
  }

  /// Whether to run this round. The first one is always run; a further one if the longest round so far would
  /// fit into the time left. After a failure there are no more rounds, so that somebody can look at it.
  bool GoesOn(int round) const {
    const int done = round - options_.first_round;
    const bool failed = !report_.failures.empty() ||
                        (!report_.rounds.empty() && !report_.rounds.back().result.failures.empty());
    if (StopSignal::Requested() || failed || (options_.rounds > 0 && done >= options_.rounds)) {
      return false;
    }
    return done == 0 || longest_round_s_ < LeftSeconds();
  }

  void RunDisturbed(int number) {
    // Faults stop after a time, so that they can't prevent the end of the run for ever. Until the limit there
    // is then ample time to end.
    const double usual_s = report_.undisturbed.wall_s;
    const FaultPlan plan(options_.seed, number, experiment_.run().actors());
    SoakRoundReport round = {number, ToText(plan.disturbance()), {}, RepeatCommand(options_, number)};
    round.result = RunRound({experiment_, report_.folder / fmt::format("round-{}", number), plan, 4 * usual_s,
                             8 * usual_s + 60, options_.key_file},
                            Progress(fmt::format("round {}", number)));
    Judge(round.result);
    longest_round_s_ = std::max(longest_round_s_, round.result.wall_s);
    faults_before_ += round.result.faults.size();
    report_.rounds.push_back(std::move(round));
    if (const auto self = ReadProcess(getpid())) {
      report_.after_rounds.push_back(self->use);
    }
    WriteCsv(report_.folder / "soak.csv", FaultHeader(), FaultRows(report_));
  }

  void Judge(RoundResult& result) const {
    const auto add = [&](const std::vector<std::string>& found) {
      result.failures.insert(result.failures.end(), found.begin(), found.end());
    };
    if (result.facts) {
      add(Differences(*report_.undisturbed.facts, *result.facts));
    }
    add(Excesses(report_.undisturbed.use, result.use, memory_allowance_kib_));
  }

  void CheckWhatIsLeft() {
    const auto add = [this](const std::string& what, const std::vector<std::string>& found) {
      if (!found.empty()) {
        report_.failures.push_back(fmt::format("left behind: {}: {}", what, fmt::join(found, ", ")));
      }
    };
    add("processes", ProcessesLeftBehind(report_.folder));
    add("half-written files", FilesLeftBehind(report_.folder));
    // Twice the allowance, since the soak's own record of the faults grows, too.
    const std::vector<std::string> leaks = Leaks(report_.after_rounds, 2 * memory_allowance_kib_);
    report_.failures.insert(report_.failures.end(), leaks.begin(), leaks.end());
  }

  RoundProgress Progress(const std::string& name) {
    return [this, name](const learner_status_t* status, size_t faults) {
      line_.Show(fmt::format(
          "{} | {} of {} episodes | {} faults so far | {:.0f} s left{}", name, status ? status->episodes : 0,
          status ? status->total_episodes : 0, faults_before_ + faults, std::max(0.0, LeftSeconds()),
          status && !status->waiting_for.empty() ? " | waits for " + status->waiting_for : ""));
    };
  }

  const SoakOptions& options_;
  const int64_t memory_allowance_kib_ = int64_t{1024} * options_.memory_allowance_mib;
  Experiment experiment_;
  SoakReport report_;
  LiveLine line_;
  int64_t begin_us_ = MonotonicMicroseconds();
  double longest_round_s_ = 0;
  size_t faults_before_ = 0;
};

int RunSoak(const SoakOptions& options) {
  const SoakReport report = Soak(options).Run();
  if (options.format == "json") {
    fmt::print("{}\n", SoakJson(report));
  } else {
    fmt::print("{}\nruns, logs and faults (soak.csv): {}\n", SoakText(report), report.folder.string());
  }
  return report.passed() ? 0 : 1;
}

}  // namespace

void AddSoak(CLI::App& app, Command& command) {
  auto options = std::make_shared<SoakOptions>();
  CLI::App* soak = app.add_subcommand(
      "soak", "Train again and again under random faults, and compare the weights with an undisturbed run");
  soak->add_option("--minutes", options->minutes, "How long to run; at least one round is run in any case")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e5));
  soak->add_option("--config", options->config, ConfigHelp("ci with 2,000 episodes"))
      ->type_name("EXPERIMENT");
  soak->add_option("--set", options->settings, "Override one field: path=value; may be repeated")
      ->type_name("PATH=VALUE");
  soak->add_option("--actors", options->actors, "Local actor processes")->check(CLI::Range(1, 1024));
  soak->add_option("--seed", options->seed, "Seed of the faults")->capture_default_str();
  soak->add_option("--first-round", options->first_round, "Begin with this round's faults")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000'000));
  soak->add_option("--rounds", options->rounds,
                   "The most rounds to run; default: as many as fit into the time")
      ->check(CLI::Range(1, 1'000'000'000));
  soak->add_option("--out", options->out, "New folder for the runs; default: one under runs/")
      ->type_name("FOLDER");
  soak->add_option("--lcm-url", options->lcm_url, "Where learner and actors meet")->type_name("URL");
  AddKeyFileOption(*soak, options->key_file);
  AddArithmeticOption(*soak);
  soak->add_option("--memory-allowance-mib", options->memory_allowance_mib,
                   "Under faults, a program may need 1.25 times its memory without faults plus so much; the "
                   "soak itself may grow by twice as much over its rounds")
      ->capture_default_str()
      ->check(CLI::Range(0, 1 << 20));
  soak->add_option("--format", options->format, "How the result is printed")->check(OneOf({"text", "json"}));
  soak->footer(
      HelpExamples({"fresco soak --minutes 5",
                    "fresco soak --first-round 17 --rounds 1         # repeats the faults of a round"}));
  soak->callback([options, &command] { command = [options] { return RunSoak(*options); }; });
}

}  // namespace fresco
