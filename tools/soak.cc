#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "core/clock.h"
#include "core/error.h"
#include "core/stop_signal.h"
#include "msgs/settings.h"
#include "tools/installation.h"
#include "tools/live_line.h"
#include "tools/soak_report.h"
#include "tools/soak_round.h"
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
  int rounds = 0;  // 0: as many as the time is good for
  std::string out;
  std::string lcm_url;
  std::string format = "text";
};

/// What a soak asks of a run, before --set: some seconds of training, nothing beside it, and checkpoints
/// often enough that a killed learner has little to do again.
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
      Experiment::Load(options.config.empty() ? ConfigPath("ci.textproto") : options.config, settings);
  if (experiment.run().actors() < 1) {
    throw UsageError("run.actors: a soak kills and stops its own actors; expected at least 1, found 0");
  }
  return experiment;
}

std::string Quoted(const std::string& argument) {
  return "'" + argument + "'";
}

std::string RepeatCommand(const SoakOptions& options, int round) {
  std::string command =
      fmt::format("tools/fresco soak --seed {} --first-round {} --rounds 1", options.seed, round);
  if (!options.config.empty()) {
    command += " --config " + Quoted(options.config);
  }
  for (const std::string& setting : options.settings) {
    command += " --set " + Quoted(setting);
  }
  if (options.actors) {
    command += fmt::format(" --actors {}", *options.actors);
  }
  if (!options.lcm_url.empty()) {
    command += " --lcm-url " + Quoted(options.lcm_url);
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
    const RoundOptions options = {experiment_, report_.folder / "undisturbed", {}, 0, 60 * options_.minutes};
    report_.undisturbed = RunRound(options, Progress("the undisturbed run"));
    report_.failures = report_.undisturbed.failures;
    for (std::string& failure : report_.failures) {
      failure =
          "the undisturbed run (name more --minutes or fewer episodes where it only takes long): " + failure;
    }
  }

  /// At least one round; further ones where they fit into the time, as far as the ones before tell. None
  /// after a failure: it is to be looked at.
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
    // Faults cease before a run could be kept from its end for good; by the limit it has had ample time.
    const double usual_s = report_.undisturbed.wall_s;
    const FaultPlan plan(options_.seed, number, experiment_.run().actors());
    SoakRoundReport round = {number, ToText(plan.disturbance()), {}, RepeatCommand(options_, number)};
    round.result = RunRound(
        {experiment_, report_.folder / fmt::format("round-{}", number), plan, 4 * usual_s, 8 * usual_s + 60},
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
    add(Excesses(report_.undisturbed.use, result.use));
  }

  void CheckWhatIsLeft() {
    const auto add = [this](const std::string& what, const std::vector<std::string>& found) {
      if (!found.empty()) {
        report_.failures.push_back(fmt::format("left behind: {}: {}", what, fmt::join(found, ", ")));
      }
    };
    add("processes", ProcessesLeftBehind(report_.folder));
    add("half-written files", FilesLeftBehind(report_.folder));
    const std::vector<std::string> leaks = Leaks(report_.after_rounds);
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
      "soak", "Train again and again under random faults and hold the weights against an undisturbed run");
  soak->add_option("--minutes", options->minutes, "For so long; at least one round is run whatever it takes")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e5));
  soak->add_option("--config", options->config,
                   "Experiment; default: configs/ci.textproto with 2,000 episodes");
  soak->add_option("--set", options->settings, "Override one field: path=value; may be repeated");
  soak->add_option("--actors", options->actors, "Local actor processes")->check(CLI::Range(1, 1024));
  soak->add_option("--seed", options->seed, "Of the faults")->capture_default_str();
  soak->add_option("--first-round", options->first_round, "Begin with this round's faults")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000'000));
  soak->add_option("--rounds", options->rounds, "So many rounds at most; default: what fits into the time")
      ->check(CLI::Range(1, 1'000'000'000));
  soak->add_option("--out", options->out, "New folder for the runs; default: one under runs/");
  soak->add_option("--lcm-url", options->lcm_url, "Where learner and actors meet");
  soak->add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  soak->callback([options, &command] { command = [options] { return RunSoak(*options); }; });
}

}  // namespace fresco
