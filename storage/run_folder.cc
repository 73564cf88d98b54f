#include "storage/run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <system_error>

#include "core/bytes.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "storage/metrics.h"
#include "storage/network_file.h"
#include "storage/plans.h"

namespace fresco {
namespace {

constexpr char kStartNetwork[] = "start.network";
constexpr char kEventsFile[] = "events.out.tfevents.fresco";  // TensorBoard looks for files with "tfevents"

std::string MetricsHeader(const WorldDescription& description) {
  std::string header =
      "wall_s,episodes,transitions,updates,version,epsilon,learning_rate,loss," + description.success;
  for (const Quantity& figure : description.figures) {
    header += "," + figure.name;
  }
  return header + "\n";
}

}  // namespace

void RunFolder::CheckNew(const std::filesystem::path& directory) {
  CheckOutputFolder(directory);
  if (std::filesystem::exists(directory)) {
    const FolderLock lock(directory);
    RefuseResults(directory);
  }
}

void RunFolder::Make(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) {
    throw UsageError(fmt::format("--out: can't make the folder {}: {}", directory.string(), error.message()));
  }
}

RunFolder::RunFolder(std::filesystem::path directory, const Experiment& experiment, Use use)
    : directory_(std::move(directory)),
      experiment_(experiment),
      checkpoints_(directory_),
      metrics_(MetricsHeader(experiment.world().description())) {
  Make(directory_);
  if (use == Use::kNewRun) {
    RefuseResults(directory_);
  } else {
    ClearLeftovers();
  }
  WriteFileAtomically(directory_ / "config.textproto", experiment.Text());
  if (experiment.start() != nullptr) {
    WriteFileAtomically(directory_ / kStartNetwork,
                        SerializeNetworkFile({experiment, 0, 0, *experiment.start()}));
  }
}

Experiment RunFolder::WithStart(const Experiment& experiment, const std::filesystem::path& directory) {
  std::error_code error;
  const std::filesystem::path path = directory / kStartNetwork;
  if (!experiment.agent().has_start_crc32c() || !std::filesystem::exists(path, error)) {
    return experiment;
  }
  auto parameters = std::make_shared<const Vector>(ReadNetworkFile(path).parameters);
  const uint32_t found = Crc32c(Values(*parameters));
  Expect(found == experiment.agent().start_crc32c(), path.string(),
         fmt::format(
             "expected the network with CRC-32C {:08x}, from which this run starts; found one with {:08x}",
             experiment.agent().start_crc32c(), found));
  return experiment.StartingFrom(std::move(parameters));
}

void RunFolder::RefuseResults(const std::filesystem::path& directory) {
  if (std::filesystem::exists(directory / "summary.json")) {
    throw UsageError(
        fmt::format("--out: {} holds another run's results; name a new folder", directory.string()));
  }
  if (!CheckpointFolder(directory).Latest().empty()) {
    throw UsageError(
        fmt::format("--out: {} holds a run that is not complete; continue it (--resume {}) or "
                    "name a new folder",
                    directory.string(), directory.string()));
  }
}

/// Deletes the summary of an interrupted run, and temporary files of a process that was killed.
void RunFolder::ClearLeftovers() const {
  std::filesystem::remove(directory_ / "summary.json");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory_)) {
    if (IsTemporaryOfAtomicFile(entry.path())) {
      std::filesystem::remove(entry.path());
    }
  }
}

void RunFolder::AddMetrics(const Evaluation& evaluation, const TrainerProgress& progress, double wall_s) {
  metrics_ += fmt::format("{:.3f},{},{},{},{},{:.6g},{:.6g},{:.6g},{:g}", wall_s, evaluation.episodes,
                          progress.transitions, evaluation.updates, evaluation.version, progress.epsilon,
                          progress.learning_rate, progress.loss, evaluation.success);
  for (const double figure : evaluation.figures) {
    metrics_ += fmt::format(",{:.10g}", figure);
  }
  metrics_ += '\n';
  writer_.Write({"metrics", directory_ / "metrics.csv", [text = metrics_] { return text; }, {}});
  writer_.Write(
      {"lines", directory_ / "metrics.jsonl", [text = metrics_] { return MetricsJsonLines(text); }, {}});
  const double begin_s = 1e-6 * static_cast<double>(WallMicroseconds()) - wall_s;
  writer_.Write({"events",
                 directory_ / kEventsFile,
                 [text = metrics_, begin_s] { return TensorBoardEvents(text, begin_s); },
                 {}});
}

void RunFolder::WriteBest(const BestNetwork& best) {
  const StoredNetwork network{experiment_, best.evaluation.version, best.evaluation.updates,
                              *best.parameters};
  writer_.Write(
      {"best", directory_ / "best.network", [network] { return SerializeNetworkFile(network); }, {}});
}

void RunFolder::WriteCheckpoint(std::shared_ptr<const Checkpoint> checkpoint) {
  const int64_t committed_orders = checkpoint->training.progress.committed_orders;
  const int kept = experiment_.run().checkpoints_kept();
  writer_.Write({kCheckpoint, checkpoints_.PathFor(committed_orders),
                 [this, checkpoint] {
                   checkpoints_.Make();
                   return SerializeCheckpoint(*checkpoint);
                 },
                 [this, kept] { checkpoints_.Prune(kept); }});
}

void RunFolder::WriteFinal(const Vector& parameters, const TrainerProgress& progress) {
  WriteFileAtomically(
      directory_ / "final.network",
      SerializeNetworkFile({experiment_, progress.current_version, progress.updates, parameters}));
}

void RunFolder::WriteSummary(const std::string& json) {
  WriteFileAtomically(directory_ / "summary.json", json + "\n");
}

void RunFolder::WriteOptimum(std::vector<uint64_t> seeds, std::vector<std::shared_ptr<const Plan>> plans) {
  if (std::all_of(plans.begin(), plans.end(), [](const auto& plan) { return plan == nullptr; })) {
    return;
  }
  writer_.Write({"optimum",
                 directory_ / kOptimumFile,
                 [this, seeds = std::move(seeds), plans = std::move(plans)] {
                   return OptimumJson(experiment_.world(), seeds, plans) + "\n";
                 },
                 {}});
}

std::vector<std::shared_ptr<const Plan>> RunFolder::ReadOptimum(std::span<const uint64_t> seeds) const {
  std::vector<std::shared_ptr<const Plan>> plans = PlansIn(directory_, experiment_.world(), seeds);
  for (std::shared_ptr<const Plan>& plan : plans) {
    if (plan != nullptr && !plan->optimal) {
      plan = nullptr;
    }
  }
  return plans;
}

std::string NewestRunHint(const std::filesystem::path& folder, const std::string& file) {
  std::filesystem::path newest;
  std::filesystem::file_time_type newest_time;
  std::error_code error;  // ignored: a folder that can't be read is no run
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const auto time = std::filesystem::last_write_time(entry.path() / file, error);
    if (!error && (newest.empty() || time > newest_time)) {
      newest = entry.path();
      newest_time = time;
    }
  }
  return newest.empty() ? "" : "; the newest run in it is " + newest.string();
}

std::filesystem::path NewRunFolder() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char name[32];
  std::strftime(name, sizeof name, "%Y%m%dT%H%M%SZ", &utc);
  return std::filesystem::path("runs") / fmt::format("{}-{}", name, getpid());
}

}  // namespace fresco
