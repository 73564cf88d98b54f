#include "tools/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/atomic_file.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/stop_signal.h"
#include "tools/live_line.h"
#include "tools/training_run.h"
#include "uav/flight.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

StudyResult ResultOf(const Json& summary, const Path& folder) {
  if (summary.at("lower_bound_average_aoi").is_null()) {
    throw Failure(
        fmt::format("the search for the optimum of {} failed; see its learner.log", folder.string()));
  }
  const Json& baselines = summary.at("baselines");
  StudyResult result;
  result.arrived = summary.at("arrived").get<bool>();
  result.average_aoi = summary.at("average_aoi").get<double>();
  result.total_aoi = summary.at("total_aoi").get<int64_t>();
  result.aoi_average_aoi = baselines.at("aoi").at("average_aoi").get<double>();
  result.distance_average_aoi = baselines.at("distance").at("average_aoi").get<double>();
  result.aoi_total_aoi = baselines.at("aoi").at("total_aoi").get<int64_t>();
  result.distance_total_aoi = baselines.at("distance").at("total_aoi").get<int64_t>();
  result.optimum_proved = !summary.at("optimal_total_aoi").is_null();
  result.lower_bound_average_aoi = summary.at("lower_bound_average_aoi").get<double>();
  result.optimal_total_aoi = result.optimum_proved ? summary.at("optimal_total_aoi").get<int64_t>() : 0;
  result.gap_percent = GapPercent(result.average_aoi, result.lower_bound_average_aoi);
  result.updates = summary.at("updates").get<int64_t>();
  result.weights_crc32c = summary.at("weights_crc32c").get<std::string>();
  return result;
}

/// The summary of a run that is complete; none where it has to be run (again).
std::optional<Json> CompleteSummary(const Path& folder, const StudyJob& job) {
  if (!std::filesystem::exists(folder / "summary.json")) {
    return std::nullopt;
  }
  const Json summary = Json::parse(ReadFile(folder / "summary.json"));
  const std::string hash = fmt::format("{:08x}", job.experiment.hash());
  if (summary.at("config_hash") != hash) {
    throw UsageError(
        fmt::format("--out: {} holds a run of configuration {}, expected {}: the folder belongs to a study "
                    "with other options; name a new folder",
                    folder.string(), summary.at("config_hash").get<std::string>(), hash));
  }
  return summary.at("completed").get<bool>() ? std::optional(summary) : std::nullopt;
}

class Study {
 public:
  Study(const std::vector<StudyJob>& jobs, const StudyOptions& options)
      : jobs_(jobs), options_(options), results_(jobs.size()), line_(true) {
    for (size_t job = 0; job < jobs_.size(); ++job) {
      if (const auto summary = CompleteSummary(FolderOf(job), jobs_[job])) {
        results_[job] = ResultOf(*summary, FolderOf(job));
      } else {
        waiting_.push_back(job);
      }
    }
    to_run_ = waiting_.size();
  }

  std::vector<StudyResult> Run() {
    constexpr int64_t kPollUs = 50'000;
    running_.resize(static_cast<size_t>(options_.parallel));
    while (done_ < to_run_) {
      for (size_t place = 0; place < running_.size(); ++place) {
        if (!running_[place] && !waiting_.empty()) {
          Start(place);
        }
        if (running_[place] && !running_[place]->run.Step(kPollUs)) {
          Finish(place);
        }
      }
      if (StopSignal::Requested()) {
        EndAll();
        throw Failure(fmt::format("stopped; {} of {} runs are complete, and the same command goes on there",
                                  jobs_.size() - to_run_ + done_, jobs_.size()));
      }
      ShowProgress();
    }
    return results_;
  }

 private:
  struct Running {
    Running(size_t its_job, const Experiment& experiment, const Path& folder, const BusOptions& bus_options)
        : job(its_job), run(experiment, folder, bus_options) {}
    size_t job;
    TrainingRun run;
  };

  Path FolderOf(size_t job) const { return options_.folder / jobs_[job].name; }

  /// Each place has channels of its own, so that runs side by side share one bus.
  void Start(size_t place) {
    const size_t job = waiting_.front();
    waiting_.pop_front();
    proto::ExperimentConfig config = jobs_[job].experiment.config();
    if (place > 0) {
      config.mutable_run()->set_channel_prefix(
          fmt::format("{}_{}", config.run().channel_prefix(), place + 1));
    }
    std::filesystem::remove_all(FolderOf(job));  // what an interrupted study left of this run
    running_[place] = std::make_unique<Running>(job, Experiment::Make(config, jobs_[job].name), FolderOf(job),
                                                options_.bus);
    running_[place]->run.Start();
  }

  void Finish(size_t place) {
    Running& running = *running_[place];
    const int status = running.run.End();
    const Json summary = Json::parse(running.run.Summary());
    if (status != 0 && !StopSignal::Requested()) {
      throw Failure(fmt::format("run {} ended with exit status {}; see {}", jobs_[running.job].name, status,
                                (FolderOf(running.job) / "learner.log").string()));
    }
    if (status == 0) {
      results_[running.job] = ResultOf(summary, FolderOf(running.job));
      ++done_;
    }
    running_[place].reset();
  }

  void EndAll() {
    for (const auto& running : running_) {
      if (running) {
        running->run.End();
      }
    }
  }

  double Share(const Running& running) const {
    const auto& status = running.run.status();
    return status ? static_cast<double>(status->episodes) / static_cast<double>(status->total_episodes) : 0;
  }

  void ShowProgress() {
    double runs_done = static_cast<double>(done_);
    std::string going_on;
    for (const auto& running : running_) {
      if (running) {
        runs_done += Share(*running);
        going_on += fmt::format(" | {} {:.0f} %", jobs_[running->job].name, 100 * Share(*running));
      }
    }
    const double passed_s = static_cast<double>(MonotonicMicroseconds() - begin_us_) * 1e-6;
    const std::string left =
        runs_done > 0.2 ? fmt::format(", about {:.0f} min left",
                                      passed_s / runs_done * (static_cast<double>(to_run_) - runs_done) / 60)
                        : "";
    line_.Show(fmt::format("{} of {} runs complete{}{}", jobs_.size() - to_run_ + done_, jobs_.size(), left,
                           going_on));
  }

  const std::vector<StudyJob>& jobs_;
  const StudyOptions& options_;
  std::vector<StudyResult> results_;
  std::deque<size_t> waiting_;                     // jobs
  std::vector<std::unique_ptr<Running>> running_;  // by place
  size_t to_run_ = 0;
  size_t done_ = 0;
  int64_t begin_us_ = MonotonicMicroseconds();
  LiveLine line_;
};

}  // namespace

std::vector<StudyResult> RunStudy(const std::vector<StudyJob>& jobs, const StudyOptions& options) {
  return Study(jobs, options).Run();
}

}  // namespace fresco
