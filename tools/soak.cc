#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "processes/run_checks.h"
#include "soak/soak_options.h"
#include "soak/soak_report.h"
#include "soak/soak_round.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

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
  AddSoakOptions(*soak, *options);
  soak->callback([options, &command] { command = [options] { return RunSoak(*options); }; });
}

}  // namespace fresco
