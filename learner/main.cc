// fresco-learner: the learner process of one run; see learner/trainer.h and learner/learner_node.h.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <random>
#include <thread>

#include "core/clock.h"
#include "core/error.h"
#include "core/state_signal.h"
#include "core/stop_signal.h"
#include "core/version.h"
#include "learner/learner_node.h"
#include "learner/run_folder.h"
#include "learner/summary.h"
#include "msgs/settings.h"

namespace fresco {
namespace {

struct Arguments {
  std::string config = "configs/quick.textproto";
  std::vector<std::string> settings;
  std::string lcm_url;
  std::string out;
  std::string run_id;
};

/// Names the run; has no influence on what it learns.
int64_t DrawRunId() {
  std::random_device device;
  return static_cast<int64_t>((uint64_t{device()} << 31) ^ device() ^ 1u) & INT64_MAX;
}

/// Thrown out of an update where the program was asked to stop.
struct Interrupted {};

/// One run from its first order to its summary.
class LearnerProcess {
 public:
  LearnerProcess(const Experiment& experiment, int64_t run_id, Bus& bus, const std::string& out)
      : experiment_(experiment),
        world_(experiment.scenario()),
        run_id_(run_id),
        bus_(&bus),
        node_(experiment_, world_, run_id, bus, ChannelsWithPrefix(experiment.run().channel_prefix())),
        trainer_(experiment_, world_, Output()),
        folder_(out, experiment_),
        optimum_limits_{experiment.run().optimum_limit_s(),
                        int64_t{experiment.run().optimum_memory_mb()} * 1'000'000} {}

  /// Returns whether the run was completed; otherwise it was interrupted.
  bool Run() {
    RefuseTakenBus();
    begin_us_ = MonotonicMicroseconds();
    optimum_.emplace(world_, optimum_limits_);
    std::exception_ptr network_error;
    std::jthread network([&](std::stop_token stop) {
      try {
        while (!stop.stop_requested()) {
          node_.Step();
          if (StateSignal::TakeRequest()) {
            spdlog::info("{}", node_.StateText());
          }
        }
        node_.AnnounceEnd();
      } catch (...) {
        network_error = std::current_exception();
        StopSignal::Request();
      }
    });
    Train();
    wall_s_ = WallSeconds();
    WaitForOptimum();
    network.request_stop();
    network.join();
    if (network_error) {
      std::rethrow_exception(network_error);
    }
    WriteResults();
    return completed_;
  }

 private:
  TrainerOutput Output() {
    TrainerOutput output;
    output.order = [this](const Order& order) { node_.WriteOrder(order); };
    output.version = [this](NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters) {
      node_.OfferVersion(kind, version, std::move(parameters));
    };
    output.evaluation = [this](const Evaluation& evaluation) {
      folder_.AddMetrics(evaluation, trainer_.progress(), WallSeconds());
      if (trainer_.best()->evaluation.version == evaluation.version) {
        folder_.WriteBest(*trainer_.best());
      }
    };
    output.updated = [this] {
      constexpr int64_t kUpdatesPerReport = 16;
      if (trainer_.progress().updates % kUpdatesPerReport == 0) {
        Report();
      }
      if (StopSignal::Requested()) {
        throw Interrupted{};
      }
    };
    return output;
  }

  /// Another run on the same channels would share actors and bandwidth: say so before starting.
  void RefuseTakenBus() {
    constexpr int64_t kListenUs = 700'000;  // a running learner announces itself every 500 ms
    const int64_t until_us = MonotonicMicroseconds() + kListenUs;
    while (MonotonicMicroseconds() < until_us && node_.foreign_run() == 0 && !StopSignal::Requested()) {
      bus_->Poll(until_us - MonotonicMicroseconds());
    }
    if (node_.foreign_run() != 0) {
      throw UsageError(fmt::format(
          "run {:016x} is already on {} with channel prefix {}; give this run a port of its own, e.g. "
          "--lcm-url 'udpm://239.255.76.67:7668?ttl=0', or end the other one",
          static_cast<uint64_t>(node_.foreign_run()), experiment_.run().lcm_url(),
          experiment_.run().channel_prefix()));
    }
  }

  void Train() {
    constexpr int64_t kWaitUs = 200'000;
    try {
      trainer_.Begin();
      while (!trainer_.finished() && !StopSignal::Requested()) {
        if (const auto next = node_.WaitForNext(kWaitUs)) {
          trainer_.Commit(next->order, next->episode);
          Report();
        }
      }
    } catch (const Interrupted&) {
      spdlog::info("interrupted after {} updates", trainer_.progress().updates);
    }
    Report();
  }

  /// The search may outlast a short training; an interrupted run does not wait for it.
  void WaitForOptimum() {
    constexpr int64_t kReportUs = 200'000;
    while (!StopSignal::Requested() && !optimum_->WaitForEnd(kReportUs)) {
      node_.SetFinishing(
          fmt::format("the search for the exact optimum, {:.0f} s more at most", optimum_->seconds_left()));
      Report();
    }
    completed_ = trainer_.finished() && optimum_->WaitForEnd(0);
    optimum_->Stop();
    Report();
  }

  void Report() {
    node_.SetProgress(trainer_.progress(), trainer_.last_evaluation(), trainer_.best());
    if (const auto bound = optimum_->bound()) {
      node_.SetOptimum(*bound);
    }
  }

  double WallSeconds() const { return static_cast<double>(MonotonicMicroseconds() - begin_us_) * 1e-6; }

  void WriteResults() {
    const std::shared_ptr<const Plan> plan = optimum_->plan();
    if (plan != nullptr) {
      folder_.WriteOptimum(OptimumJson(world_, *plan));
    }
    folder_.WriteFinal(trainer_.current(), trainer_.progress());
    folder_.WriteSummary(
        SummaryJson({experiment_, world_, run_id_, completed_, wall_s_, trainer_, node_.counters(), plan}));
  }

  Experiment experiment_;
  World world_;
  int64_t run_id_;
  Bus* bus_;
  LearnerNode node_;
  Trainer trainer_;
  RunFolder folder_;
  OptimumSearch::Limits optimum_limits_;
  std::optional<OptimumSearch> optimum_;  // from the run's beginning
  int64_t begin_us_ = 0;
  double wall_s_ = 0;       // of the training
  bool completed_ = false;  // training and search came to their ends
};

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Trains a DQN from the transitions that actors send over LCM. `fresco train` starts it for you.");
  app.set_version_flag("--version", kSoftwareVersion);
  app.add_option("--config", arguments.config, "Experiment, in text format")->capture_default_str();
  app.add_option("--set", arguments.settings, "Overrides one field: path=value; may be repeated");
  app.add_option("--lcm-url", arguments.lcm_url, "Overrides run.lcm_url");
  app.add_option("--out", arguments.out, "The run's folder")->required();
  app.add_option("--run-id", arguments.run_id, "Name of the run (16 hexadecimal digits); default: drawn");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ErrorKind::kUsage);
  }
  Settings settings = ParseSettings(arguments.settings);
  if (!arguments.lcm_url.empty()) {
    settings.emplace_back("run.lcm_url", arguments.lcm_url);
  }
  const Experiment experiment = Experiment::Load(arguments.config, settings);
  const int64_t run_id = arguments.run_id.empty() ? DrawRunId() : ParseRunId(arguments.run_id);
  const std::unique_ptr<Bus> bus = OpenLcmBus(experiment.run().lcm_url());
  spdlog::info("run {:016x}, configuration {:08x}, on {}", static_cast<uint64_t>(run_id), experiment.hash(),
               experiment.run().lcm_url());
  return LearnerProcess(experiment, run_id, *bus, arguments.out).Run() ? 0 : 1;
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("fresco-learner"));
  spdlog::set_pattern("%H:%M:%S %n[%P] %l: %v");
  fresco::StopSignal::Install();
  fresco::StateSignal::Install();
  try {
    return fresco::Main(argc, argv);
  } catch (const fresco::Error& error) {
    spdlog::error("{}", error.what());
    return error.exit_status();
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
