#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <random>

#include "bus/bus.h"
#include "core/atomic_file.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/stop_signal.h"
#include "msgs/channels.h"
#include "msgs/settings.h"
#include "tools/child_process.h"
#include "tools/installation.h"
#include "tools/subcommands.h"
#include "tools/train_display.h"

namespace fresco {
namespace {

struct TrainOptions {
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> actors;
  std::optional<uint64_t> seed;
  std::string out;
  std::string lcm_url;
  std::string format = "text";
};

Experiment LoadExperiment(const TrainOptions& options) {
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
  return Experiment::Load(options.config.empty() ? DefaultConfigPath() : options.config, settings);
}

std::filesystem::path DefaultFolder() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char name[32];
  std::strftime(name, sizeof name, "%Y%m%dT%H%M%SZ", &utc);
  return std::filesystem::path("runs") / fmt::format("{}-{}", name, getpid());
}

/// Starts and minds the processes of one run.
class TrainSupervisor {
 public:
  TrainSupervisor(const Experiment& experiment, std::filesystem::path folder, bool show_progress)
      : experiment_(experiment),
        folder_(std::move(folder)),
        run_id_(fmt::format("{:016x}", DrawRunId())),
        bus_(OpenLcmBus(experiment.run().lcm_url())),
        display_(show_progress) {
    Listen();
  }

  /// Returns the learner's exit status.
  int Run() {
    PrepareFolder();
    learner_ = std::make_unique<ChildProcess>(LearnerArguments(), folder_ / "learner.log");
    actors_.resize(static_cast<size_t>(experiment_.run().actors()));
    constexpr int64_t kPollUs = 50'000;
    while (!learner_->ExitStatus() && !StopSignal::Requested()) {
      KeepActorsAlive();
      bus_->Poll(kPollUs);
    }
    // The learner first: it writes the run's folder while the actors may still be flying.
    constexpr int64_t kPatienceUs = 20'000'000;
    const int status = learner_->End(kPatienceUs);
    EndActors();
    display_.Finish();
    return status;
  }

 private:
  /// One local actor's place, and how often its process died at once.
  struct ActorPlace {
    std::unique_ptr<ChildProcess> process;
    int early_deaths = 0;
    int64_t start_at_us = 0;
  };

  static uint64_t DrawRunId() {
    std::random_device device;
    return ((uint64_t{device()} << 31) ^ device()) | 1u;
  }

  void Listen() {
    const Channels channels = ChannelsWithPrefix(experiment_.run().channel_prefix());
    const int64_t run_id = ParseRunId(run_id_);
    bus_->Subscribe(channels.learner_status, [this, run_id](std::span<const std::byte> bytes) {
      learner_status_t status{};
      if (Decode(bytes, status) && status.run_id == run_id) {
        display_.Show(status, MonotonicMicroseconds());
      }
    });
  }

  void PrepareFolder() {
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

  std::vector<std::string> LearnerArguments() const {
    return {SiblingProgram("fresco-learner").string(),
            "--config",
            (folder_ / "config.textproto").string(),
            "--out",
            folder_.string(),
            "--run-id",
            run_id_};
  }

  std::vector<std::string> ActorArguments() const {
    return {SiblingProgram("fresco-actor").string(),
            "--lcm-url",
            experiment_.run().lcm_url(),
            "--channel-prefix",
            experiment_.run().channel_prefix(),
            "--run-id",
            run_id_};
  }

  void KeepActorsAlive() {
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

  void NoteDeath(ActorPlace& place, const std::filesystem::path& log, int64_t now_us) {
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

  void EndActors() {
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

  Experiment experiment_;
  std::filesystem::path folder_;
  std::string run_id_;
  std::unique_ptr<Bus> bus_;
  ProgressDisplay display_;
  std::unique_ptr<ChildProcess> learner_;
  std::vector<ActorPlace> actors_;
};

int Train(const TrainOptions& options) {
  const Experiment experiment = LoadExperiment(options);
  const std::filesystem::path folder =
      options.out.empty() ? DefaultFolder() : std::filesystem::path(options.out);
  const bool text = options.format == "text";
  if (text) {
    fmt::print("training over {} with {} local actors; results go to {}\n", experiment.run().lcm_url(),
               experiment.run().actors(), folder.string());
    std::fflush(stdout);
  }
  const int status = TrainSupervisor(experiment, folder, true).Run();
  if (!std::filesystem::exists(folder / "summary.json")) {
    throw Error(
        status == 2 ? ErrorKind::kUsage : ErrorKind::kFailure,
        "the learner ended without results; its log ends with:" + LastLines(folder / "learner.log", 3));
  }
  const std::string summary = ReadFile(folder / "summary.json");
  fmt::print("{}", text ? ResultTable(summary) : summary);
  if (status != 0) {
    fmt::print(stderr, "fresco: the run was interrupted; what it learned so far is in {}\n", folder.string());
  } else if (text) {
    fmt::print("\nfly it: tools/fresco evaluate --policy {}\n", folder.string());
  }
  return status == 0 ? 0 : 1;
}

}  // namespace

void AddTrain(CLI::App& app, Command& command) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* train =
      app.add_subcommand("train", "Train over LCM: one learner, several actors, and a table at the end");
  train->add_option("--config", options->config, "Experiment; default: configs/quick.textproto");
  train->add_option("--set", options->settings, "Override one field: path=value; may be repeated");
  train->add_option("--actors", options->actors, "Local actor processes; 0: wait for actors that join")
      ->check(CLI::Range(0, 1024));
  train->add_option("--seed", options->seed, "Seed of everything random");
  train->add_option("--out", options->out, "Folder for the results; default: a new one under runs/");
  train->add_option("--lcm-url", options->lcm_url, "Where learner and actors meet");
  train->add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  train->callback([options, &command] { command = [options] { return Train(*options); }; });
}

}  // namespace fresco
