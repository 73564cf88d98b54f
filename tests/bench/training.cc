// Whole trainings by real processes.
//
// train_busy: the part of the wall time that the learner's training thread uses a processor during `fresco
// train` with the default experiment, fewer episodes and one learner thread, from its first update on; the
// reference is all of the time. train_updates: the updates a second in that time, beside the same update in a
// loop that does nothing else (update.cc measures that one beside its roof), in turns with the trainings. Of
// three trainings the best counts.
//
// learner_memory_mb, actor_memory_mb: the most resident memory of a learner and of an actor at the paper's
// sizes, with the replay memory full and without the search for the optimum, whose memory
// run.optimum_memory_mb limits. There are fewer updates than in the paper, which changes no size. The
// reference is the project's limit.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/child_process.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/installation.h"
#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "tests/bench/alternate.h"
#include "tests/bench/stop.h"
#include "tests/bench/subjects.h"
#include "tests/bench/update_loop.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

constexpr char kTrainingUrl[] = "udpm://239.255.76.67:7883?ttl=0";

/// Throws Failure with the last lines of the log unless the process ends well.
void WaitForSuccess(
    ChildProcess& process, const std::filesystem::path& log, const std::function<void()>& meanwhile = [] {}) {
  constexpr int64_t kTurnUs = 5'000;
  std::optional<int> status;
  while (!(status = process.Wait(kTurnUs))) {
    ThrowIfStopped();
    meanwhile();
  }
  if (*status != 0) {
    throw Failure(fmt::format("a training ended with status {}{}", *status, LastLines(log, 5)));
  }
}

/// `updating` of the summary of a training of so many episodes.
nlohmann::json UpdatingOfTraining(int episodes) {
  const TemporaryFolder folder;
  const std::filesystem::path log = folder.path() / "log";
  ChildProcess process(
      {SiblingProgram("fresco").string(), "train", "--out", folder.path() / "run", "--lcm-url", kTrainingUrl,
       "--set", fmt::format("schedule.episodes={}", episodes), "--set", "run.learner_threads=1", "--set",
       "run.optimum_limit_s=0", "--format", "json"},
      log);
  WaitForSuccess(process, log);
  return nlohmann::json::parse(ReadFile(folder.path() / "run" / "summary.json")).at("updating");
}

Results Training(double seconds) {
  constexpr int kRounds = 3;
  constexpr double kEpisodesPerSecond = 100;  // about; of training
  constexpr int kFewestEpisodes = 100;        // the first 30 fill the replay memory for the first update
  const Experiment experiment = Experiment::Load(ExperimentPath(kDefaultExperiment));
  DqnOptions options;
  options.double_dqn = experiment.agent().double_dqn();
  options.batch_size = experiment.agent().batch_size();
  UpdateLoop loop(experiment.network(), options);
  const int episodes = std::max(kFewestEpisodes, static_cast<int>(kEpisodesPerSecond * seconds));
  const auto update = [&] {
    loop.Step();
    return 1.0;
  };
  double busy = 0;
  double updates_per_s = 0;
  double alone_per_s = 0;
  for (int round = 0; round < kRounds; ++round) {
    const nlohmann::json updating = UpdatingOfTraining(episodes);
    const auto wall_s = updating.at("wall_s").get<double>();
    busy = std::max(busy, updating.at("training_thread_s").get<double>() / wall_s);
    updates_per_s = std::max(updates_per_s, updating.at("updates").get<double>() / wall_s);
    alone_per_s = std::max(alone_per_s, SpeedOf(update, seconds / kRounds));
  }
  constexpr double kPercent = 100;
  return {{MoreIsBetter("train_busy", kPercent * busy, "%",
                        fmt::format("all of the wall time from the first update of {} episodes", episodes),
                        kPercent),
           MoreIsBetter("train_updates", updates_per_s, "updates/s",
                        "the same update in a loop on one thread", alone_per_s)},
          {}};
}

double PeakMegabytes(pid_t pid) {
  std::ifstream status(fmt::format("/proc/{}/status", pid));
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) {
      return std::stod(line.substr(6)) * 1024e-6;
    }
  }
  return 0;
}

Results Memory(double) {
  const TemporaryFolder folder;
  const std::filesystem::path log = folder.path() / "log";
  ChildProcess learner({SiblingProgram("fresco-learner").string(), "--config", "paper", "--out",
                        folder.path() / "run", "--lcm-url", kTrainingUrl, "--set", "run.optimum_limit_s=0",
                        "--set", "schedule.episodes=900", "--set", "schedule.inserts_per_update=40"},
                       log);
  ChildProcess actor({SiblingProgram("fresco-actor").string(), "--lcm-url", kTrainingUrl, "--once"},
                     std::filesystem::path("/dev/null"));
  double learner_mb = 0;
  double actor_mb = 0;
  WaitForSuccess(learner, log, [&] {
    learner_mb = std::max(learner_mb, PeakMegabytes(learner.pid()));
    actor_mb = std::max(actor_mb, PeakMegabytes(actor.pid()));
  });
  return {{LessIsBetter("learner_memory_mb", learner_mb, "MB", "the limit at the paper's sizes", 100),
           LessIsBetter("actor_memory_mb", actor_mb, "MB", "the limit at the paper's sizes", 30)},
          {}};
}

}  // namespace

std::vector<Subject> TrainingSubjects() {
  return {{{"train_busy", "train_updates"}, Training}, {{"learner_memory_mb", "actor_memory_mb"}, Memory}};
}

}  // namespace fresco
