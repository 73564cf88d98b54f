#include "tools/training_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <random>

#include "core/atomic_file.h"
#include "core/clock.h"
#include "core/error.h"
#include "msgs/channels.h"
#include "msgs/settings.h"
#include "tools/installation.h"

namespace fresco {
namespace {

/// Names the run; has no influence on what it learns.
uint64_t DrawRunId() {
  std::random_device device;
  return ((uint64_t{device()} << 31) ^ device()) | 1u;
}

}  // namespace

TrainingRun::TrainingRun(const Experiment& experiment, std::filesystem::path folder)
    : experiment_(experiment),
      folder_(std::move(folder)),
      run_id_(fmt::format("{:016x}", DrawRunId())),
      bus_(OpenLcmBus(experiment.run().lcm_url())) {
  PrepareFolder();
  Listen();
}

void TrainingRun::PrepareFolder() {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw UsageError(fmt::format("--out: can't make the folder {}: {}", folder_.string(), error.message()));
  }
  if (std::filesystem::exists(folder_ / "summary.json")) {
    throw UsageError(
        fmt::format("--out: {} holds another run's results; name a new folder", folder_.string()));
  }
  WriteFileAtomically(folder_ / "config.textproto", experiment_.Text());
}

void TrainingRun::Listen() {
  const Channels channels = ChannelsWithPrefix(experiment_.run().channel_prefix());
  const int64_t run_id = ParseRunId(run_id_);
  bus_->Subscribe(channels.learner_status, [this, run_id](std::span<const std::byte> bytes) {
    learner_status_t status{};
    if (Decode(bytes, status) && status.run_id == run_id) {
      status_ = std::move(status);
    }
  });
}

void TrainingRun::Start() {
  learner_ = std::make_unique<ChildProcess>(LearnerArguments(), folder_ / "learner.log");
  actors_.resize(static_cast<size_t>(experiment_.run().actors()));
}

bool TrainingRun::Step(int64_t timeout_us) {
  if (learner_->ExitStatus()) {
    return false;
  }
  KeepActorsAlive();
  bus_->Poll(timeout_us);
  return true;
}

int TrainingRun::End() {
  // The learner first: it writes the run's folder while the actors may still be flying.
  constexpr int64_t kPatienceUs = 20'000'000;
  const int status = learner_->End(kPatienceUs);
  EndActors();
  return status;
}

std::string TrainingRun::Summary() const {
  if (!std::filesystem::exists(folder_ / "summary.json")) {
    throw Error(
        learner_->ExitStatus() == static_cast<int>(ErrorKind::kUsage) ? ErrorKind::kUsage
                                                                      : ErrorKind::kFailure,
        "the learner ended without results; its log ends with:" + LastLines(folder_ / "learner.log", 3));
  }
  return ReadFile(folder_ / "summary.json");
}

std::vector<std::string> TrainingRun::LearnerArguments() const {
  return {SiblingProgram("fresco-learner").string(),
          "--config",
          (folder_ / "config.textproto").string(),
          "--out",
          folder_.string(),
          "--run-id",
          run_id_};
}

std::vector<std::string> TrainingRun::ActorArguments() const {
  return {SiblingProgram("fresco-actor").string(),
          "--lcm-url",
          experiment_.run().lcm_url(),
          "--channel-prefix",
          experiment_.run().channel_prefix(),
          "--run-id",
          run_id_};
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
  constexpr int64_t kEarlyUs = 2'000'000;
  constexpr int kGiveUpAfter = 5;
  constexpr int64_t kFirstPauseUs = 100'000;
  constexpr int64_t kLongestPauseUs = 5'000'000;
  const int status = place.process->ExitStatus().value();
  const bool killed = status == 128 + SIGKILL || status == 128 + SIGTERM;  // by somebody else: it can start
  const bool early = !killed && now_us - place.process->started_us() < kEarlyUs;
  place.early_deaths = early ? place.early_deaths + 1 : 0;
  if (place.early_deaths >= kGiveUpAfter) {
    throw Failure(fmt::format("an actor ended {} times right after its start; its log {} ends with:{}",
                              kGiveUpAfter, log.string(), LastLines(log, 3)));
  }
  place.start_at_us = now_us + (early ? std::min(kLongestPauseUs, kFirstPauseUs << place.early_deaths) : 0);
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
      place.process->End(kPatienceUs);
    }
  }
}

}  // namespace fresco
