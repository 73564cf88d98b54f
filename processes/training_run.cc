#include "processes/training_run.h"

#include <fmt/format.h>

#include <csignal>

#include "actors/served_run.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "learner/learner_process.h"
#include "msgs/channels.h"
#include "msgs/worlds.h"
#include "nn/arithmetic.h"

namespace fresco {
namespace {

/// Throws UsageError if the folder of a run can't be written to or, for a new run, holds another run.
void CheckRunFolder(const std::filesystem::path& folder, RunFolder::Use use) {
  if (use == RunFolder::Use::kNewRun) {
    RunFolder::CheckNew(folder);
  } else {
    CheckOutputFolder(folder, "--resume");
  }
}

/// What every process of a run gets.
void AddCommonArguments(const BusOptions& options, std::vector<std::string>& command) {
  command.insert(command.end(), {"--arithmetic", CurrentArithmetic().name});
  if (options.key_file) {
    command.insert(command.end(), {"--key-file", options.key_file->string()});
  }
  if (options.disturbance) {
    command.insert(command.end(), {"--disturb", ToText(*options.disturbance)});
  }
}

}  // namespace

void CheckRun(const Experiment& experiment) {
  experiment.FirstParameters();  // refuses a start that is missing
  SiblingProgram("fresco-learner");
  if (experiment.run().actors() > 0) {
    SiblingProgram("fresco-actor");
  }
  MemoryNeed actors = ActorMemory(experiment, experiment.run().environments_per_actor());
  actors.processes = experiment.run().actors();
  RefuseIfTooLarge({LearnerMemory(experiment), actors}, ReadAvailableMemory());
}

void CheckRunAndBus(const Experiment& experiment, const BusOptions& bus_options) {
  CheckRun(experiment);
  OpenBus(experiment.run().lcm_url(), bus_options);
}

Resumption ReadInterruptedRun(const std::filesystem::path& folder, const Settings& settings) {
  const FolderLock lock(folder, kResumePatienceUs);
  return ReadResumption(folder, settings);
}

std::vector<std::string> ActorCommand(const Experiment& experiment, const BusOptions& bus_options,
                                      std::optional<int64_t> run_id) {
  std::vector<std::string> command = {SiblingProgram("fresco-actor").string(), "--lcm-url",
                                      experiment.run().lcm_url(), "--channel-prefix",
                                      experiment.run().channel_prefix()};
  if (run_id) {
    command.insert(command.end(), {"--run-id", IdentifierText(*run_id)});
  }
  if (const std::string code = CodeOf(experiment.config()); !code.empty()) {
    command.insert(command.end(), {"--allow-code", code});
  }
  AddCommonArguments(bus_options, command);
  return command;
}

TrainingRun::TrainingRun(const Experiment& experiment, std::filesystem::path folder,
                         const BusOptions& bus_options)
    : TrainingRun(experiment, std::move(folder), bus_options, RunFolder::Use::kNewRun, DrawIdentifier()) {}

TrainingRun::TrainingRun(const Resumption& resumption, std::filesystem::path folder,
                         const BusOptions& bus_options)
    : TrainingRun(resumption.experiment, std::move(folder), bus_options, RunFolder::Use::kResume,
                  resumption.checkpoint ? resumption.checkpoint->run_id : DrawIdentifier()) {}

TrainingRun::TrainingRun(const Experiment& experiment, std::filesystem::path folder,
                         const BusOptions& bus_options, RunFolder::Use use, int64_t run_id)
    : experiment_(experiment),
      folder_(std::move(folder)),
      bus_options_(bus_options),
      use_(use),
      run_id_(run_id) {
  CheckRun(experiment_);
  CheckRunFolder(folder_, use_);
  bus_ = OpenBus(experiment_.run().lcm_url(), {bus_options_.key_file});
  messages_.emplace(*bus_);
  Listen();
}

/// Makes the folder and writes the configuration, which the learner reads from there.
void TrainingRun::PrepareFolder() const {
  RunFolder::Make(folder_);
  const FolderLock lock(folder_, use_ == RunFolder::Use::kResume ? kResumePatienceUs : 0);
  const RunFolder folder(folder_, experiment_, use_);
}

void TrainingRun::Listen() {
  // Statuses come five times a second, and nobody polls while the processes end and the report is written.
  constexpr int kQueueCapacity = 64;
  const Channels channels = ChannelsWithPrefix(experiment_.run().channel_prefix());
  const auto take = [this](const learner_status_t& status) {
    if (status.run_id == run_id_) {
      status_ = status;
      heard_us_ = MonotonicMicroseconds();
    }
  };
  messages_->Subscribe<learner_status_t>(channels.learner_status, take, kQueueCapacity);
}

void TrainingRun::Start() {
  PrepareFolder();
  if (record_split_mb_) {
    recorder_ = std::make_unique<RunRecorder>(folder_, experiment_.run().lcm_url(), *record_split_mb_);
  }
  learner_ = std::make_unique<ChildProcess>(LearnerCommand(), folder_ / "learner.log");
  heard_us_ = MonotonicMicroseconds();
  actors_.resize(static_cast<size_t>(experiment_.run().actors()));
}

bool TrainingRun::Step(int64_t timeout_us) {
  if (learner_->ExitStatus()) {
    return false;
  }
  KeepActorsAlive();
  if (recorder_) {
    recorder_->Step();
  }
  bus_->Poll(timeout_us);
  GiveUpOnASilentLearner();
  return true;
}

double TrainingRun::SilentSeconds() const {
  return static_cast<double>(MonotonicMicroseconds() - heard_us_) * 1e-6;
}

void TrainingRun::GiveUpOnASilentLearner() const {
  const double patience_s = experiment_.run().patience_s();
  if (patience_s > 0 && SilentSeconds() >= patience_s) {
    throw Failure(fmt::format(
        "nothing was heard of the learner (pid {}) for {:.0f} s (run.patience_s), but it is still "
        "running; its log {} ends with:{}",
        learner_->pid(), patience_s, (folder_ / "learner.log").string(),
        LastLines(folder_ / "learner.log", 3)));
  }
}

int TrainingRun::End() {
  // The learner first: it writes the run's folder while the actors may still be flying.
  constexpr int64_t kPatienceUs = 20'000'000;
  const int status = learner_->End(kPatienceUs);
  EndActors();
  if (recorder_) {
    recorder_->End();
  }
  return status;
}

void TrainingRun::SignalLearner(int signal_number) {
  learner_->Signal(signal_number);
}

void TrainingRun::SignalActor(int number, int signal_number) {
  const auto& process = actors_.at(static_cast<size_t>(number)).process;
  if (process != nullptr) {
    process->Signal(signal_number);
  }
}

std::vector<pid_t> TrainingRun::Pids() const {
  std::vector<pid_t> pids = {learner_->pid()};
  for (const LocalActor& actor : actors_) {
    if (actor.process != nullptr) {
      pids.push_back(actor.process->pid());
    }
  }
  return pids;
}

std::string TrainingRun::Summary() const {
  if (!std::filesystem::exists(folder_ / "summary.json")) {
    throw Error(learner_->ExitStatus() == static_cast<int>(ErrorKind::kUsage) ? ErrorKind::kUsage
                                                                              : ErrorKind::kFailure,
                fmt::format("the learner ended without results{}; its log ends with:{}",
                            CheckpointFolder(folder_).Latest().empty()
                                ? ""
                                : fmt::format(" (continue with: {})", ResumeCommand()),
                            LastLines(folder_ / "learner.log", 3)));
  }
  return ReadFile(folder_ / "summary.json");
}

std::string TrainingRun::ResumeCommand() const {
  return fmt::format("{} train --resume {}{}{}", ProgramName(), folder_.string(),
                     bus_options_.key_file ? " --key-file " + bus_options_.key_file->string() : "",
                     record_split_mb_ ? " --record" : "");
}

std::vector<std::string> TrainingRun::LearnerCommand() {
  std::vector<std::string> command = {SiblingProgram("fresco-learner").string(), "--run-id",
                                      IdentifierText(run_id_)};
  if (use_ == RunFolder::Use::kResume) {
    command.insert(command.end(), {"--resume", folder_.string()});
  } else {
    command.insert(command.end(),
                   {"--config", (folder_ / "config.textproto").string(), "--out", folder_.string()});
  }
  AddCommonArguments(NextBusOptions(), command);
  return command;
}

/// Returns the bus options of the next process. If they disturb messages, each has a seed of its own.
BusOptions TrainingRun::NextBusOptions() {
  BusOptions options = bus_options_;
  if (options.disturbance) {
    options.disturbance->seed += started_processes_++;
  }
  return options;
}

void TrainingRun::KeepActorsAlive() {
  for (size_t i = 0; i < actors_.size(); ++i) {
    LocalActor& actor = actors_[i];
    const auto log = folder_ / fmt::format("actor-{}.log", i);
    const int64_t now_us = MonotonicMicroseconds();
    if (actor.process != nullptr && actor.process->ExitStatus()) {
      NoteDeath(actor, log, now_us);
    }
    if (actor.process == nullptr && now_us >= actor.start_at_us) {
      actor.process =
          std::make_unique<ChildProcess>(ActorCommand(experiment_, NextBusOptions(), run_id_), log);
    }
  }
}

void TrainingRun::NoteDeath(LocalActor& actor, const std::filesystem::path& log, int64_t now_us) {
  const int status = actor.process->ExitStatus().value();
  actor_failures_ += RestartPolicy::EndedByOthers(status) ? 0 : 1;
  const int64_t pause_us = actor.restarts.NoteDeath(status, now_us - actor.process->started_us());
  if (actor.restarts.hopeless()) {
    throw Failure(
        fmt::format("an actor ended {} times right after its start, or in its world; its log {} ends with:{}",
                    RestartPolicy::kHopelessAfter, log.string(), LastLines(log, 3)));
  }
  actor.start_at_us = now_us + pause_us;
  actor.process.reset();
}

void TrainingRun::EndActors() {
  constexpr int64_t kPatienceUs = 3'000'000;
  for (LocalActor& actor : actors_) {
    if (actor.process != nullptr) {
      actor.process->Signal(SIGTERM);
    }
  }
  for (LocalActor& actor : actors_) {
    if (actor.process != nullptr) {
      actor.process->WaitForEnd(kPatienceUs);
    }
  }
}

}  // namespace fresco
