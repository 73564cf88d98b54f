#include "logs/retrain_run.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
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

using OrderedJson = nlohmann::ordered_json;

std::string SameRunText(const RetrainReport& report) {
  const Retraining::Counts& counts = report.counts;
  std::string text =
      fmt::format("{} episodes from the log, {} flown again\n", counts.recorded_episodes, counts.flown_again);
  if (counts.different_versions > 0) {
    text += fmt::format(
        "NOT the recorded run: {} of the {} network versions in the log differ, from version {} on; another "
        "build of Fresco recorded it, or the log was changed\n",
        counts.different_versions, counts.compared_versions, counts.first_different_version);
  } else if (counts.compared_versions > 0) {
    text += fmt::format("the recorded run: all {} versions of its networks in the log have the same bits\n",
                        counts.compared_versions);
  } else {
    text += "the log contains no version of the run's networks to compare with\n";
  }
  return text;
}

std::string ExperienceText(const RetrainReport& report) {
  return fmt::format(
      "another agent, trained offline: {} recorded episodes that other networks flew, {} left out (its masks "
      "forbid them), {} evaluations flown by its own networks\n",
      report.counts.recorded_episodes, report.counts.left_out, report.counts.evaluations_flown);
}

double SecondsSince(int64_t begin_us) {
  return 1e-6 * static_cast<double>(MonotonicMicroseconds() - begin_us);
}

std::string ProgressText(const Trainer& trainer, int64_t episodes, double wall_s, const std::string& left) {
  const TrainerProgress& progress = trainer.progress();
  const auto& best = trainer.best();
  return fmt::format("episode {}/{}  updates {}  best score {}  {:.0f} updates/s  {}", progress.episodes,
                     episodes, progress.updates, best ? fmt::format("{:.2f}", best->evaluation.score()) : "-",
                     static_cast<double>(progress.updates) / wall_s, left);
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

std::string RangesText(const std::vector<Interval>& ranges) {
  constexpr size_t kShown = 12;
  std::string text;
  int64_t orders = 0;
  for (size_t i = 0; i < ranges.size(); ++i) {
    const auto& [first, last] = ranges[i];
    orders += last - first + 1;
    if (i < kShown) {
      text += fmt::format("{}{}", i == 0 ? "" : ", ",
                          first == last ? fmt::to_string(first) : fmt::format("{} to {}", first, last));
    }
  }
  if (ranges.size() > kShown) {
    text += fmt::format(" and {} more ranges", ranges.size() - kShown);
  }
  return fmt::format("{} ({} order{} in all)", text, orders, orders == 1 ? "" : "s");
}

std::string BeginText(const RetrainReport& report) {
  std::string text;
  if (report.refused > 0) {
    text += fmt::format("{} messages of the log are not authenticated with the key and were left out\n",
                        report.refused);
  }
  for (const std::string& problem : report.totals.Problems()) {
    text += problem + "\n";
  }
  text += fmt::format("retraining from run {}, ", IdentifierText(report.run.identity.run_id));
  text += report.use == Retraining::Use::kSameRun
              ? "with the recorded configuration: the result is the same weights\n"
              : "with another configuration: its episodes are experience for another agent (offline; the "
                "result is not the recorded run)\n";
  if (!report.missing.empty()) {
    text += fmt::format("the log misses the episodes of orders {}\n", RangesText(report.missing));
  }
  return text;
}

std::string EndText(const RetrainReport& report) {
  return report.use == Retraining::Use::kSameRun ? SameRunText(report) : ExperienceText(report);
}

std::string WithRetrainReport(const std::string& summary_json, const RetrainReport& report) {
  OrderedJson json = OrderedJson::parse(summary_json);
  OrderedJson logs = OrderedJson::array();
  for (const auto& log : report.logs) {
    logs.push_back(log.string());
  }
  const Retraining::Counts& counts = report.counts;
  json["retrain"] = {{"logs", logs},
                     {"recorded_run_id", IdentifierText(report.run.identity.run_id)},
                     {"recorded_config_hash", fmt::format("{:08x}", report.run.identity.config_hash)},
                     {"same_configuration", report.use == Retraining::Use::kSameRun},
                     {"recorded_episodes", counts.recorded_episodes},
                     {"flown_again", counts.flown_again},
                     {"evaluations_flown", counts.evaluations_flown},
                     {"left_out", counts.left_out},
                     {"compared_versions", counts.compared_versions},
                     {"different_versions", counts.different_versions},
                     {"log_bytes", report.totals.bytes},
                     {"damaged_bytes", report.totals.damaged_bytes},
                     {"torn_bytes", report.totals.torn_bytes},
                     {"refused_messages", report.refused}};
  return json.dump(2);
}

RetrainRun::RetrainRun(const LogSource& source, const LoggedRun& run, const Experiment& recorded,
                       const Experiment& chosen, Retraining::Use use, bool strict)
    : experiment_(chosen),
      recorded_(recorded),
      report_{source.paths, run, use},
      episodes_(source, run.identity, recorded_.world()) {
  report_.missing = episodes_.Missing();
  report_.totals = episodes_.totals();
  report_.refused = episodes_.refused();
  if (strict && !report_.missing.empty()) {
    throw Failure(fmt::format(
        "--strict: the log misses the episodes of orders {}; without --strict they would be flown again",
        RangesText(report_.missing)));
  }
  retraining_.emplace(
      experiment_, episodes_, use, strict,
      [this](const Trainer& trainer, const Evaluation& evaluation) { WriteEvaluation(trainer, evaluation); });
}

void RetrainRun::WriteEvaluation(const Trainer& trainer, const Evaluation& evaluation) {
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
  OptimumSearch optimum(
      experiment_.world(), EpisodesToPlan(experiment_),
      {experiment_.run().optimum_limit_s(), int64_t{experiment_.run().optimum_memory_mb()} * 1'000'000});
  LiveLine line(true);
  TimeLeft time_left;
  while (!StopSignal::Requested() && retraining_->Step()) {
    if (line.IsDue()) {
      const int64_t episodes = experiment_.schedule().episodes();
      const Trainer& trainer = retraining_->trainer();
      line.Show(ProgressText(trainer, episodes, SecondsSince(begin_us_),
                             time_left.Report(static_cast<double>(trainer.progress().episodes),
                                              static_cast<double>(episodes), MonotonicMicroseconds())));
    }
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
  folder_->WriteOptimum(EpisodesToPlan(experiment_), optimum.plans);
  folder_->WriteFinal(trainer.current(), trainer.progress());
  folder_->Finish();
  const std::string summary = WithRetrainReport(
      SummaryJson({experiment_, DrawIdentifier(), completed_, wall_s, trainer, {}, optimum}), report_);
  folder_->WriteSummary(summary);
  return summary;
}

}  // namespace fresco
