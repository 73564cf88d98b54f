#include "report/result_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "storage/optimum_search.h"
#include "storage/policy.h"
#include "worlds/uav/aoi_figures.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;
using TableRow = std::vector<std::string>;

std::string GreedyAoi(const learner_status_t& status) {
  if (std::isnan(status.average_aoi)) {
    return "-";
  }
  std::string text = fmt::format("{:.3f}{}", status.average_aoi, status.arrived != 0 ? "" : " (not arrived)");
  if (std::isnan(status.best_average_aoi) || std::isnan(status.lower_bound_average_aoi)) {
    return text;
  }
  text += fmt::format(", best {:.3f} ", status.best_average_aoi);
  return text + (status.optimum_proved != 0
                     ? fmt::format("({:.2f} % over the optimum)", status.gap_percent)
                     : fmt::format("(optimum not proved, at least {:.3f})", status.lower_bound_average_aoi));
}

constexpr char kNotProved[] = "not proved";

bool SearchedFor(const Json& summary) {
  return summary.at("optimum_search") != SearchEndName(SearchEnd::kOff);
}

TableRow FiguresRow(const std::string& name, const Json& figures, const Json& summary) {
  const Json average = figures.value("average_aoi", Json());
  if (average.is_null()) {
    return {name, "-", "-", "-", "not evaluated"};
  }
  const bool arrived = figures.at("arrived").get<bool>();
  const Json& optimal = summary.at("optimal_average_aoi");
  std::string gap = arrived && SearchedFor(summary) ? kNotProved : "-";
  if (arrived && !optimal.is_null()) {
    gap = fmt::format("{:.2f} %", GapPercent(average.get<double>(), optimal.get<double>()));
  }
  return {name, fmt::format("{:.3f}", average.get<double>()),
          std::to_string(figures.at("total_aoi").get<int64_t>()), gap, arrived ? "yes" : "NO"};
}

}  // namespace

std::string ProgressLine(const learner_status_t& status) {
  const std::string warning = status.warning.empty() ? "" : "WARNING: " + status.warning + " | ";
  if (status.episodes == status.total_episodes && !status.waiting_for.empty()) {
    return warning + fmt::format("trained, waits for {} | {} episodes | {} updates | greedy AoI {}",
                                 status.waiting_for, status.episodes, status.updates, GreedyAoi(status));
  }
  const double percent = 100.0 * static_cast<double>(status.episodes) /
                         static_cast<double>(std::max<int64_t>(1, status.total_episodes));
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
  const bool proved = !summary.at("optimal_average_aoi").is_null();
  const Json& found = summary.at("best_found_average_aoi");
  std::vector<TableRow> rows = {
      {"policy", "average AoI", "total AoI", "gap", "arrived"},
      FiguresRow("this run (DQN)", summary, summary),
      FiguresRow("AoI-based", summary.at("baselines").at("aoi"), summary),
      FiguresRow("distance-based", summary.at("baselines").at("distance"), summary)};
  if (!found.is_null()) {
    rows.push_back({FoundFlightName(proved), fmt::format("{:.3f}", found.get<double>()),
                    std::to_string(summary.at("best_found_total_aoi").get<int64_t>()),
                    proved ? "0.00 %" : kNotProved, "yes"});
  }
  return rows;
}

std::string OptimumNote(const std::string& summary_json) {
  const Json summary = Json::parse(summary_json);
  const Json& bound = summary.at("lower_bound_average_aoi");
  const std::string end = summary.at("optimum_search");
  if (end == SearchEndName(SearchEnd::kFailed)) {
    return "The search for the exact optimum failed; the log says why.";
  }
  if (end == SearchEndName(SearchEnd::kOff) || end == SearchEndName(SearchEnd::kProved)) {
    return "";
  }
  std::string note = fmt::format(
      "The exact optimum is not proved: the search {}. No flight has an average AoI below {:.3f}",
      end == SearchEndName(SearchEnd::kStopped) ? "was stopped"
                                                : "reached run.optimum_limit_s or run.optimum_memory_mb",
      bound.get<double>());
  if (summary.value("arrived", Json()) == true) {
    note +=
        fmt::format("; this run lies above the optimum by at most {:.2f} %, which is a bound and not the gap",
                    GapPercent(summary.at("average_aoi").get<double>(), bound.get<double>()));
  }
  return note + ".";
}

std::string ResultTable(const std::string& summary_json) {
  const std::vector<TableRow> rows = PolicyRows(summary_json);
  size_t name_width = 16;
  for (const TableRow& row : rows) {
    name_width = std::max(name_width, row[0].size());
  }
  std::string table;
  for (const TableRow& row : rows) {
    table += fmt::format("  {:<{}} {:>12} {:>10} {:>12}  {}\n", row[0], name_width, row[1], row[2], row[3],
                         row[4]);
  }
  const std::string note = OptimumNote(summary_json);
  return note.empty() ? table : table + note + "\n";
}

std::string FlightJson(const World& world, const Episode& flight, const std::string& policy,
                       const std::optional<Plan>& plan) {
  const AoiFigures figures = Figures(world, flight);
  OrderedJson json = {{"policy", policy},
                      {"arrived", flight.arrived()},
                      {"outcome", OutcomeName(flight.outcome)},
                      {"slots", flight.states.size()},
                      {"total_aoi", figures.total_aoi},
                      {"average_aoi", figures.average_aoi},
                      {"sum_aoi", figures.sum_aoi},
                      {"residual_energy_j", ResidualEnergy(world, flight)}};
  if (plan) {
    json["optimal"] = plan->optimal;
    json["lower_bound_total_aoi"] = plan->lower_bound_total_aoi;
    json["lower_bound_average_aoi"] = plan->lower_bound_average_aoi;
  }
  OrderedJson& slots = json["flight"] = OrderedJson::array();
  for (size_t slot = 0; slot < flight.states.size(); ++slot) {
    const State& state = flight.states[slot];
    const Action action = ActionIn(world, flight, slot);
    slots.push_back({{"slot", state.slot},
                     {"column", state.cell.column},
                     {"row", state.cell.row},
                     {"move", MoveName(action.move)},
                     {"scheduled", action.schedule},
                     {"aoi", state.aoi}});
  }
  return json.dump(2);
}

}  // namespace fresco
