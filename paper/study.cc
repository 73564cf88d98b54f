#include "paper/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "processes/training_run.h"
#include "storage/checkpoint_folder.h"
#include "storage/summary.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

std::string HashText(const Experiment& experiment) {
  return fmt::format("{:08x}", experiment.hash());
}

void RefuseOtherConfiguration(const Path& folder, const std::string& found, const StudyJob& job) {
  const std::string expected = HashText(job.experiment);
  if (found != expected) {
    throw UsageError(
        fmt::format("--out: {} holds a run of configuration {}, expected {}: the folder belongs to a study "
                    "with other options; name a new folder",
                    folder.string(), found, expected));
  }
}

/// Returns the result of a finished run (IsFinished); none if it still has to be run or resumed. Throws
/// UsageError if the folder holds a run with another configuration than the job's.
std::optional<StudyResult> CompleteResult(const Path& folder, const StudyJob& job) {
  if (!std::filesystem::exists(folder / "summary.json")) {
    return std::nullopt;
  }
  const std::string text = ReadFile(folder / "summary.json");
  RefuseOtherConfiguration(folder, Json::parse(text).at("config_hash").get<std::string>(), job);
  return IsFinished(text) ? std::optional(ResultOf(text, folder)) : std::nullopt;
}

/// Returns what is needed to resume a run that was interrupted; none if it has no checkpoint. Throws as
/// CompleteResult does, and UsageError if it has checkpoints but none can be read.
std::optional<Resumption> InterruptedRun(const Path& folder, const StudyJob& job) {
  if (CheckpointFolder(folder).Latest().empty()) {
    return std::nullopt;
  }
  Resumption resumption = ReadInterruptedRun(folder);
  RefuseOtherConfiguration(folder, HashText(resumption.experiment), job);
  return resumption;
}

class Study {
 public:
  Study(const std::vector<StudyJob>& jobs, const StudyOptions& options)
      : jobs_(jobs), options_(options), results_(jobs.size()), line_(true) {
    for (size_t job = 0; job < jobs_.size(); ++job) {
      if (const auto result = CompleteResult(FolderOf(job), jobs_[job])) {
        results_[job] = *result;
      } else {
        CheckJob(job);
        waiting_.push_back(job);
      }
    }
    to_run_ = waiting_.size();
  }

  std::vector<StudyResult> Run() {
    constexpr int64_t kPollUs = 50'000;
    running_.resize(static_cast<size_t>(options_.parallel));
    while (done_ < to_run_) {
      for (size_t lane = 0; lane < running_.size(); ++lane) {
        if (!running_[lane] && !waiting_.empty()) {
          Start(lane);
        }
        if (running_[lane] && !running_[lane]->run->Step(kPollUs)) {
          Finish(lane);
        }
      }
      if (StopSignal::Requested()) {
        EndAll();
        throw Failure(fmt::format("stopped; {} of {} runs are complete; the same command continues the study",
                                  jobs_.size() - to_run_ + done_, jobs_.size()));
      }
      ShowProgress();
    }
    return results_;
  }

 private:
  struct Running {
    size_t job;
    std::unique_ptr<TrainingRun> run;
  };

  /// Called for all jobs before the first run starts, since the last one may start an hour later.
  void CheckJob(size_t job) const {
    InterruptedRun(FolderOf(job), jobs_[job]);
    if (waiting_.empty()) {  // only for the first job, since all have the same bus
      CheckRunAndBus(jobs_[job].experiment, options_.bus);
    } else {
      CheckRun(jobs_[job].experiment);
    }
  }

  Path FolderOf(size_t job) const { return options_.folder / jobs_[job].name; }

  /// Each lane has channels of its own, so that runs side by side share one bus.
  Experiment ExperimentAt(size_t lane, size_t job) const {
    proto::ExperimentConfig config = jobs_[job].experiment.config();
    if (lane > 0) {
      config.mutable_run()->set_channel_prefix(fmt::format("{}_{}", config.run().channel_prefix(), lane + 1));
    }
    return Experiment::Make(config, jobs_[job].name);
  }

  std::unique_ptr<TrainingRun> MakeRun(size_t lane, size_t job) const {
    const Path folder = FolderOf(job);
    const Experiment experiment = ExperimentAt(lane, job);
    if (std::optional<Resumption> interrupted = InterruptedRun(folder, jobs_[job])) {
      interrupted->experiment = experiment;  // differs in `run` only: lane and LCM URL may have changed
      return std::make_unique<TrainingRun>(*interrupted, folder, options_.bus);
    }
    std::filesystem::remove_all(folder);  // a run can't continue from what is there
    return std::make_unique<TrainingRun>(experiment, folder, options_.bus);
  }

  void Start(size_t lane) {
    const size_t job = waiting_.front();
    waiting_.pop_front();
    running_[lane].emplace(Running{job, MakeRun(lane, job)});
    running_[lane]->run->Start();
  }

  void Finish(size_t lane) {
    Running& running = *running_[lane];
    const int status = running.run->End();
    running.run->Summary();  // throws with the learner's own words if there is no summary
    const auto result = CompleteResult(FolderOf(running.job), jobs_[running.job]);
    if (!result && !StopSignal::Requested()) {
      throw Failure(fmt::format("run {} ended with exit status {}; see {}", jobs_[running.job].name, status,
                                (FolderOf(running.job) / "learner.log").string()));
    }
    if (result) {
      results_[running.job] = *result;
      ++done_;
    }
    running_[lane].reset();
  }

  void EndAll() {
    for (const auto& running : running_) {
      if (running) {
        running->run->End();
      }
    }
  }

  double Share(const Running& running) const {
    const auto& status = running.run->status();
    return status ? static_cast<double>(status->episodes) / static_cast<double>(status->total_episodes) : 0;
  }

  std::string Progress(const Running& running) const {
    const auto& status = running.run->status();
    return Share(running) < 1 || status->waiting_for.empty()
               ? fmt::format("{:.0f} %", 100 * Share(running))
               : fmt::format("is trained and waits for {}", status->waiting_for);
  }

  void ShowProgress() {
    double runs_done = static_cast<double>(done_);
    std::string going_on;
    for (const auto& running : running_) {
      if (running) {
        runs_done += Share(*running);
        going_on += fmt::format(" | {} {}", jobs_[running->job].name, Progress(*running));
      }
    }
    const std::string left =
        time_left_.Report(runs_done, static_cast<double>(to_run_), MonotonicMicroseconds());
    line_.Show(fmt::format("{} of {} runs complete{}{}", jobs_.size() - to_run_ + done_, jobs_.size(),
                           left.empty() ? "" : " | " + left, going_on));
  }

  const std::vector<StudyJob>& jobs_;
  const StudyOptions& options_;
  std::vector<StudyResult> results_;
  std::deque<size_t> waiting_;                   // indices of jobs that have not started
  std::vector<std::optional<Running>> running_;  // by lane
  size_t to_run_ = 0;
  size_t done_ = 0;
  TimeLeft time_left_;
  LiveLine line_;
};

}  // namespace

StudyResult ResultOf(const std::string& summary_json, const Path& folder) {
  const Json summary = Json::parse(summary_json);
  if (summary.at("lower_bound_average_aoi").is_null()) {
    throw Failure(
        fmt::format("the search for the optimum of {} failed; see its learner.log", folder.string()));
  }
  const auto policy_result = [](const Json& figures) {
    return PolicyResult{figures.at("average_aoi").get<double>(), figures.at("total_aoi").get<int64_t>()};
  };
  StudyResult result;
  result.arrived = summary.at("arrived").get<bool>();
  result.dqn = policy_result(summary);
  result.aoi_based = policy_result(summary.at("baselines").at("aoi"));
  result.distance_based = policy_result(summary.at("baselines").at("distance"));
  result.lower_bound_average_aoi = summary.at("lower_bound_average_aoi").get<double>();
  if (!summary.at("optimal_total_aoi").is_null()) {
    result.optimal = {summary.at("optimal_average_aoi").get<double>(),
                      summary.at("optimal_total_aoi").get<int64_t>()};
    result.gap_percent = GapPercent(result.dqn.average_aoi, result.lower_bound_average_aoi);
  }
  result.updates = summary.at("updates").get<int64_t>();
  result.weights_crc32c = summary.at("weights_crc32c").get<std::string>();
  return result;
}

std::vector<StudyResult> RunStudy(const std::vector<StudyJob>& jobs, const StudyOptions& options) {
  return Study(jobs, options).Run();
}

}  // namespace fresco
