#include "processes/training_run.h"

#include <fmt/format.h>

#include <csignal>

#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "msgs/channels.h"
#include "msgs/settings.h"
#include "processes/run_checks.h"

namespace fresco {
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
  learner_ = std::make_unique<ChildProcess>(LearnerArguments(), folder_ / "learner.log");
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

void TrainingRun::SignalActor(int place, int signal_number) {
  const auto& process = actors_.at(static_cast<size_t>(place)).process;
  if (process != nullptr) {
    process->Signal(signal_number);
  }
}

std::vector<pid_t> TrainingRun::Pids() const {
  std::vector<pid_t> pids = {learner_->pid()};
  for (const ActorPlace& place : actors_) {
    if (place.process != nullptr) {
      pids.push_back(place.process->pid());
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

std::vector<std::string> TrainingRun::LearnerArguments() {
  std::vector<std::string> arguments = {SiblingProgram("fresco-learner").string(), "--run-id", RunIdText()};
  if (use_ == RunFolder::Use::kResume) {
    arguments.insert(arguments.end(), {"--resume", folder_.string()});
  } else {
    arguments.insert(arguments.end(),
                     {"--config", (folder_ / "config.textproto").string(), "--out", folder_.string()});
  }
  return WithBusOptions(std::move(arguments));
}

std::vector<std::string> TrainingRun::ActorArguments() {
  return WithBusOptions({SiblingProgram("fresco-actor").string(), "--lcm-url", experiment_.run().lcm_url(),
                         "--channel-prefix", experiment_.run().channel_prefix(), "--run-id", RunIdText()});
}

std::vector<std::string> TrainingRun::WithBusOptions(std::vector<std::string> arguments) {
  if (bus_options_.key_file) {
    arguments.insert(arguments.end(), {"--key-file", bus_options_.key_file->string()});
  }
  if (bus_options_.disturbance) {
    LossOptions disturbance = *bus_options_.disturbance;
    disturbance.seed += started_processes_++;
    arguments.insert(arguments.end(), {"--disturb", ToText(disturbance)});
  }
  return arguments;
}

std::string TrainingRun::RunIdText() const {
  return fmt::format("{:016x}", static_cast<uint64_t>(run_id_));
}

void TrainingRun::KeepActorsAlive() {
  for (size_t i = 0; i < actors_.size(); ++i) {
    ActorPlace& place = actors_[i];
    const auto log = folder_ / fmt::format("actor-{}.log", i);
    const int64_t now_us = MonotonicMicroseconds();
    if (place.process != nullptr && place.process->ExitStatus()) {
      NoteDeath(place, log, now_us);
    }
    if (place.process == nullptr && now_us >= place.start_at_us) {
      place.process = std::make_unique<ChildProcess>(ActorArguments(), log);
    }
  }
}

void TrainingRun::NoteDeath(ActorPlace& place, const std::filesystem::path& log, int64_t now_us) {
  const int status = place.process->ExitStatus().value();
  actor_failures_ += RestartPolicy::EndedByOthers(status) ? 0 : 1;
  const int64_t pause_us = place.restarts.NoteDeath(status, now_us - place.process->started_us());
  if (place.restarts.hopeless()) {
    throw Failure(fmt::format("an actor ended {} times right after its start; its log {} ends with:{}",
                              RestartPolicy::kHopelessAfter, log.string(), LastLines(log, 3)));
  }
  place.start_at_us = now_us + pause_us;
  place.process.reset();
}

void TrainingRun::EndActors() {
  constexpr int64_t kPatienceUs = 3'000'000;
  for (ActorPlace& place : actors_) {
    if (place.process != nullptr) {
      place.process->Signal(SIGTERM);
    }
  }
  for (ActorPlace& place : actors_) {
    if (place.process != nullptr) {
      place.process->WaitForEnd(kPatienceUs);
    }
  }
}

Resumption ReadInterruptedRun(const std::filesystem::path& folder, const Settings& settings) {
  const FolderLock lock(folder, kResumePatienceUs);
  return ReadResumption(folder, settings);
}

}  // namespace fresco
