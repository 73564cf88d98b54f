#include "learner/run_folder.h"

#include <fmt/format.h>

#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "msgs/network_file.h"

namespace fresco {

RunFolder::RunFolder(std::filesystem::path directory, const Experiment& experiment)
    : directory_(std::move(directory)), experiment_(experiment) {
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  if (error) {
    throw UsageError(
        fmt::format("--out: can't make the folder {}: {}", directory_.string(), error.message()));
  }
  if (std::filesystem::exists(directory_ / "summary.json")) {
    throw UsageError(
        fmt::format("--out: {} holds another run's results; name a new folder", directory_.string()));
  }
  WriteFileAtomically(directory_ / "config.textproto", experiment.Text());
  metrics_ =
      "wall_s,episodes,transitions,updates,version,epsilon,learning_rate,loss,arrived,total_aoi,average_aoi,"
      "sum_aoi\n";
}

void RunFolder::AddMetrics(const Evaluation& evaluation, const TrainerProgress& progress, double wall_s) {
  metrics_ +=
      fmt::format("{:.3f},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{},{:.6f},{:.6f}\n", wall_s,
                  evaluation.episodes, progress.transitions, evaluation.updates, evaluation.version,
                  progress.epsilon, progress.learning_rate, progress.loss, evaluation.arrived ? 1 : 0,
                  evaluation.figures.total_aoi, evaluation.figures.average_aoi, evaluation.figures.sum_aoi);
  WriteFileAtomically(directory_ / "metrics.csv", metrics_);
}

void RunFolder::WriteBest(const BestNetwork& best) {
  WriteNetworkFile(directory_ / "best.network",
                   {experiment_, best.evaluation.version, best.evaluation.updates, *best.parameters});
}

void RunFolder::WriteFinal(const Vector& parameters, const TrainerProgress& progress) {
  WriteNetworkFile(directory_ / "final.network",
                   {experiment_, progress.current_version, progress.updates, parameters});
}

void RunFolder::WriteSummary(const std::string& json) {
  WriteFileAtomically(directory_ / "summary.json", json + "\n");
}

void RunFolder::WriteOptimum(const std::string& json) {
  WriteFileAtomically(directory_ / "optimum.json", json + "\n");
}

}  // namespace fresco
