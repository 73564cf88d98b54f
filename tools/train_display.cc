#include "tools/train_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "uav/flight.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using TableRow = std::vector<std::string>;

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

/// `least`: the optimum's average AoI or a lower bound on it; null: unknown.
TableRow FiguresRow(const std::string& name, const Json& figures, const Json& least) {
  const Json average = figures.value("average_aoi", Json());
  if (average.is_null()) {
    return {name, "-", "-", "-", "not evaluated"};
  }
  const bool arrived = figures.at("arrived").get<bool>();
  const std::string gap =
      least.is_null() || !arrived
          ? "-"
          : fmt::format("{:.2f} %", GapPercent(average.get<double>(), least.get<double>()));
  return {name, fmt::format("{:.3f}", average.get<double>()),
          std::to_string(figures.at("total_aoi").get<int64_t>()), gap, arrived ? "yes" : "NO"};
}

}  // namespace

std::string ProgressLine(const learner_status_t& status) {
  const double percent = 100.0 * static_cast<double>(status.episodes) /
                         static_cast<double>(std::max<int64_t>(1, status.total_episodes));
  const std::string warning = status.warning.empty() ? "" : "WARNING: " + status.warning + " | ";
  return warning + fmt::format(
                       "{:3.0f}% | {} of {} episodes | {} updates | epsilon {:.3f} | greedy AoI {} | {:.0f} "
                       "transitions/s | "
                       "{:.0f} updates/s | {} actors{}",
                       percent, status.episodes, status.total_episodes, status.updates, status.epsilon,
                       GreedyAoi(status), status.transitions_per_s, status.updates_per_s, status.actors,
                       status.waiting_for.empty() ? " | actors wait for the learner"
                                                  : " | learner waits for " + status.waiting_for);
}

std::vector<TableRow> PolicyRows(const std::string& summary_json) {
  const Json summary = Json::parse(summary_json);
  const Json& optimal = summary.at("optimal_average_aoi");
  const Json& bound = summary.at("lower_bound_average_aoi");
  const bool only_bound = optimal.is_null() && !bound.is_null();
  const Json& least = only_bound ? bound : optimal;
  std::vector<TableRow> rows = {
      {"policy", "average AoI", "total AoI", only_bound ? "gap at most" : "gap", "arrived"},
      FiguresRow("this run (DQN)", summary, least),
      FiguresRow("AoI-based", summary.at("baselines").at("aoi"), least),
      FiguresRow("distance-based", summary.at("baselines").at("distance"), least)};
  if (only_bound) {
    rows.push_back({"lower bound", fmt::format("{:.3f}", bound.get<double>()), "-", "-", "-"});
  } else if (!optimal.is_null()) {
    rows.push_back({"exact optimum", fmt::format("{:.3f}", optimal.get<double>()),
                    std::to_string(summary.at("optimal_total_aoi").get<int64_t>()), "0.00 %", "yes"});
  }
  return rows;
}

std::string ResultTable(const std::string& summary_json) {
  std::string table;
  for (const TableRow& row : PolicyRows(summary_json)) {
    table += fmt::format("  {:<16} {:>12} {:>10} {:>12}  {}\n", row[0], row[1], row[2], row[3], row[4]);
  }
  return table;
}

}  // namespace fresco
