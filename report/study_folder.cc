#include "report/study_folder.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "processes/training_run.h"
#include "storage/checkpoint_folder.h"
#include "storage/summary.h"
#include "worlds/uav/flight.h"

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

}  // namespace

StudyResult ResultOf(const std::string& summary_json, const Path& folder) {
  const Json summary = Json::parse(summary_json);
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
  result.lower_bound_average_aoi = summary.at("lower_bound_average_aoi").get<double>();
  if (!summary.at("optimal_total_aoi").is_null()) {
    result.optimal_total_aoi = summary.at("optimal_total_aoi").get<int64_t>();
    result.optimal_average_aoi = summary.at("optimal_average_aoi").get<double>();
    result.gap_percent = GapPercent(result.average_aoi, result.lower_bound_average_aoi);
  }
  result.updates = summary.at("updates").get<int64_t>();
  result.weights_crc32c = summary.at("weights_crc32c").get<std::string>();
  return result;
}

std::optional<StudyResult> CompleteResult(const Path& folder, const StudyJob& job) {
  if (!std::filesystem::exists(folder / "summary.json")) {
    return std::nullopt;
  }
  const std::string text = ReadFile(folder / "summary.json");
  RefuseOtherConfiguration(folder, Json::parse(text).at("config_hash").get<std::string>(), job);
  return IsFinished(text) ? std::optional(ResultOf(text, folder)) : std::nullopt;
}

std::optional<Resumption> InterruptedRun(const Path& folder, const StudyJob& job) {
  if (CheckpointFolder(folder).Latest().empty()) {
    return std::nullopt;
  }
  Resumption resumption = ReadInterruptedRun(folder);
  RefuseOtherConfiguration(folder, HashText(resumption.experiment), job);
  return resumption;
}

}  // namespace fresco
