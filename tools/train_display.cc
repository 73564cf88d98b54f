#include "tools/train_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "uav/flight.h"

namespace fresco {
namespace {

using Json = nlohmann::json;

std::string GreedyAoi(const learner_status_t& status) {
  if (std::isnan(status.average_aoi)) {
    return "-";
  }
  std::string text = fmt::format("{:.3f}{}", status.average_aoi, status.arrived != 0 ? "" : " (not arrived)");
  if (!std::isnan(status.gap_percent)) {
    text += fmt::format(", best {:.3f} ({}{:.2f} % over the optimum)", status.best_average_aoi,
                        status.optimum_proved != 0 ? "" : "at most ", status.gap_percent);
  }
  return text;
}

std::string Row(const std::string& name, const std::string& average, const std::string& total,
                const std::string& gap, const std::string& arrived) {
  return fmt::format("  {:<16} {:>12} {:>10} {:>10}  {}\n", name, average, total, gap, arrived);
}

/// `least`: the optimum's average AoI or a lower bound on it; null: unknown.
std::string FiguresRow(const std::string& name, const Json& figures, const Json& least) {
  const Json average = figures.value("average_aoi", Json());
  if (average.is_null()) {
    return Row(name, "-", "-", "-", "not evaluated");
  }
  const bool arrived = figures.at("arrived").get<bool>();
  const std::string gap =
      least.is_null() || !arrived
          ? "-"
          : fmt::format("{:.2f} %", GapPercent(average.get<double>(), least.get<double>()));
  return Row(name, fmt::format("{:.3f}", average.get<double>()),
             std::to_string(figures.at("total_aoi").get<int64_t>()), gap, arrived ? "yes" : "NO");
}

std::string OptimumRow(const Json& summary) {
  const Json& optimal = summary.at("optimal_average_aoi");
  if (!optimal.is_null()) {
    return Row("exact optimum", fmt::format("{:.3f}", optimal.get<double>()),
               std::to_string(summary.at("optimal_total_aoi").get<int64_t>()), "0.00 %", "yes");
  }
  const Json& bound = summary.at("lower_bound_average_aoi");
  return bound.is_null() ? "" : Row("lower bound", fmt::format("{:.3f}", bound.get<double>()), "-", "-", "-");
}

}  // namespace

std::string ProgressLine(const learner_status_t& status) {
  const double percent = 100.0 * static_cast<double>(status.episodes) /
                         static_cast<double>(std::max<int64_t>(1, status.total_episodes));
  return fmt::format(
      "{:3.0f}% | {} of {} episodes | {} updates | epsilon {:.3f} | greedy AoI {} | {:.0f} transitions/s | "
      "{:.0f} updates/s | {} actors{}",
      percent, status.episodes, status.total_episodes, status.updates, status.epsilon, GreedyAoi(status),
      status.transitions_per_s, status.updates_per_s, status.actors,
      status.waiting_for.empty() ? " | actors wait for the learner"
                                 : " | learner waits for " + status.waiting_for);
}

std::string ResultTable(const std::string& summary_json) {
  const Json summary = Json::parse(summary_json);
  const Json& optimal = summary.at("optimal_average_aoi");
  const Json& least = optimal.is_null() ? summary.at("lower_bound_average_aoi") : optimal;
  const bool proved = !optimal.is_null();
  std::string table =
      Row("policy", "average AoI", "total AoI", proved || least.is_null() ? "gap" : "gap <=", "arrived");
  table += FiguresRow("this run (DQN)", summary, least);
  table += FiguresRow("AoI-based", summary.at("baselines").at("aoi"), least);
  table += FiguresRow("distance-based", summary.at("baselines").at("distance"), least);
  return table + OptimumRow(summary);
}

}  // namespace fresco
