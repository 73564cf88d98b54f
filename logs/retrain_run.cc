#include "logs/retrain_run.h"

#include <fmt/format.h>

#include <utility>

#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/identifier.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "storage/optimum_search.h"
#include "storage/summary.h"

namespace fresco {
namespace {

double SecondsSince(int64_t begin_us) {
  return 1e-6 * static_cast<double>(MonotonicMicroseconds() - begin_us);
}

std::string ProgressText(const Trainer& trainer, int64_t episodes, double wall_s) {
  const TrainerProgress& progress = trainer.progress();
  const auto& best = trainer.best();
  return fmt::format("episode {}/{}  updates {}  best average AoI {}  {:.0f} updates/s", progress.episodes,
                     episodes, progress.updates,
                     best ? fmt::format("{:.2f}", best->evaluation.figures.average_aoi) : "-",
                     static_cast<double>(progress.updates) / wall_s);
}

void WaitForEnd(OptimumSearch& optimum, LiveLine& line) {
  constexpr int64_t kReportUs = 200'000;
  optimum.SetFullPriority();
  while (!StopSignal::Requested() && !optimum.WaitForEnd(kReportUs)) {
    line.Show(fmt::format(
        "trained; waiting for the proof of the exact optimum: at most {:.0f} s more of processor time",
        optimum.processor_seconds_left()));
  }
}

}  // namespace

RetrainRun::RetrainRun(const LogSource& source, const LoggedRun& run, const Experiment& recorded,
                       const Experiment& chosen, Retraining::Use use, bool strict)
    : experiment_(chosen),
      world_(chosen.scenario()),
      report_{source.paths, run, use},
      episodes_(source, run.identity, world_, recorded.mask_options()) {
  report_.missing = episodes_.Missing();
  report_.totals = episodes_.totals();
  report_.refused = episodes_.refused();
  if (strict && !report_.missing.empty()) {
    throw Failure(fmt::format(
        "--strict: the log misses the episodes of orders {}; without --strict they would be flown again",
        RangesText(report_.missing)));
  }
  retraining_.emplace(
      experiment_, world_, episodes_, use, strict,
      [this](const Trainer& trainer, const Evaluation& evaluation) { TakeEvaluation(trainer, evaluation); });
}

void RetrainRun::TakeEvaluation(const Trainer& trainer, const Evaluation& evaluation) {
  folder_->AddMetrics(evaluation, trainer.progress(), SecondsSince(begin_us_));
  if (trainer.best()->evaluation.version == evaluation.version) {
    folder_->WriteBest(*trainer.best());
  }
}

std::string RetrainRun::Train(const std::filesystem::path& directory) {
  begin_us_ = MonotonicMicroseconds();
  RunFolder::Make(directory);
  const FolderLock lock(directory);
  folder_.emplace(directory, experiment_);
  OptimumSearch optimum(world_, {experiment_.run().optimum_limit_s(),
                                 int64_t{experiment_.run().optimum_memory_mb()} * 1'000'000});
  LiveLine line(true);
  while (!StopSignal::Requested() && retraining_->Step()) {
    line.Show(
        ProgressText(retraining_->trainer(), experiment_.schedule().episodes(), SecondsSince(begin_us_)));
  }
  const double wall_s = SecondsSince(begin_us_);
  completed_ = retraining_->trainer().finished();
  if (completed_) {
    WaitForEnd(optimum, line);
  }
  optimum.Stop();
  report_.counts = retraining_->counts();
  return Results(wall_s, optimum.result());
}

std::string RetrainRun::Results(double wall_s, const OptimumResult& optimum) {
  const Trainer& trainer = retraining_->trainer();
  if (optimum.plan != nullptr) {
    folder_->WriteOptimum(OptimumJson(world_, *optimum.plan));
  }
  folder_->WriteFinal(trainer.current(), trainer.progress());
  folder_->Finish();
  const std::string summary = WithRetrainReport(
      SummaryJson({experiment_, world_, DrawIdentifier(), completed_, wall_s, trainer, {}, optimum}),
      report_);
  folder_->WriteSummary(summary);
  return summary;
}

}  // namespace fresco
