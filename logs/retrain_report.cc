#include "logs/retrain_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string DamageText(const RetrainReport& report) {
  const MergedEventLogs::Totals& totals = report.totals;
  std::string text;
  if (report.refused > 0) {
    text += fmt::format("{} messages of the log are not authenticated with the key and were left out\n",
                        report.refused);
  }
  if (totals.torn_bytes > 0) {
    text += fmt::format("the log is cut short: its last event ({} bytes) is incomplete\n", totals.torn_bytes);
  }
  if (totals.damaged_bytes > 0) {
    text += fmt::format("{} bytes of the log are damaged and were skipped\n", totals.damaged_bytes);
  }
  return text;
}

std::string SameRunText(const RetrainReport& report) {
  const Retraining::Counts& counts = report.counts;
  std::string text =
      fmt::format("{} episodes from the log, {} flown again\n", counts.recorded_episodes, counts.flown_again);
  if (counts.different_versions > 0) {
    text += fmt::format(
        "NOT the recorded run: {} of the {} network versions in the log differ, from version {} on; another "
        "build of Fresco or another kind of processor recorded it, or the log was changed\n",
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

}  // namespace

std::string RangesText(const std::vector<std::pair<int64_t, int64_t>>& ranges) {
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
  std::string text = DamageText(report);
  text += fmt::format("retraining from run {}, ", RunIdText(report.run));
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
                     {"recorded_run_id", RunIdText(report.run)},
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

}  // namespace fresco
