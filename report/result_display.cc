#include "report/result_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "core/utf8.h"
#include "report/report_html.h"
#include "storage/optimum_search.h"
#include "storage/policy.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;
using TableRow = std::vector<std::string>;

std::string GreedyScore(const learner_status_t& status, const WorldDescription& world) {
  if (std::isnan(status.score)) {
    return "-";
  }
  std::string text = fmt::format("{:.3f}", status.score);
  if (status.success == 0) {
    text += fmt::format(" (not {})", Title(world.success));
  } else if (status.success < 1) {
    text += fmt::format(" ({} {})", PercentText(status.success), Title(world.success));
  }
  if (std::isnan(status.best_score)) {
    return text;
  }
  if (std::isnan(status.score_bound)) {
    return world.random ? text + fmt::format(", best {:.3f}", status.best_score) : text;
  }
  text += fmt::format(", best {:.3f} ", status.best_score);
  return text + (status.optimum_proved != 0
                     ? fmt::format("({:.2f} % over the optimum{})", status.gap_percent,
                                   status.gap_worst_percent > status.gap_percent
                                       ? fmt::format(", worst {:.1f} %", status.gap_worst_percent)
                                       : "")
                     : fmt::format("(optimum not proved, at least {:.3f})", status.score_bound));
}

constexpr char kNotProved[] = "not proved";

bool SearchedFor(const Json& summary) {
  return summary.value("optimum_search", SearchEndName(SearchEnd::kOff)) != SearchEndName(SearchEnd::kOff);
}

std::string FigureText(const Json& value) {
  return value.is_number_integer() ? std::to_string(value.get<int64_t>())
                                   : fmt::format("{:.3f}", value.get<double>());
}

/// The figures that tables show.
std::vector<std::string> FigureNames(const Json& summary) {
  constexpr size_t kShown = 2;
  std::vector<std::string> names;
  for (const Json& figure : summary.at("world").at("figures")) {
    if (names.size() < kShown) {
      names.push_back(figure.at("name").get<std::string>());
    }
  }
  return names;
}

/// `figures` has them under their names with a prefix, and the success; null: not evaluated.
TableRow FiguresRow(const std::string& title, const Json& figures, const Json& summary,
                    const std::string& prefix = "") {
  const std::vector<std::string> names = FigureNames(summary);
  const bool has_gap = summary.contains("gap_percent");
  TableRow row = {title};
  if (figures.value(prefix + names.front(), Json()).is_null()) {
    row.resize(1 + names.size() + (has_gap ? 1 : 0), "-");
    row.push_back("not evaluated");
    return row;
  }
  for (const std::string& name : names) {
    const Json& figure = figures.at(prefix + name);
    row.push_back(&name == &names.front() ? fmt::format("{:.3f}", figure.get<double>()) : FigureText(figure));
  }
  const std::string success = summary.at("world").at("success");
  const bool succeeded = figures.value(prefix.empty() ? success : "", true);
  if (has_gap) {
    const bool proved = !summary.at("optimal_" + names.front()).is_null();
    const Json gap = prefix.empty() ? figures.value("gap_percent", Json()) : (proved ? Json(0.0) : Json());
    const char* none = succeeded && SearchedFor(summary) && !proved ? kNotProved : "-";
    row.push_back(gap.is_null() ? none : fmt::format("{:.2f} %", gap.get<double>()));
  }
  const double share = figures.value(prefix.empty() ? "success" : "", succeeded ? 1.0 : 0.0);
  row.push_back(succeeded ? "yes" : (share > 0 ? PercentText(share) : "NO"));
  return row;
}

/// Scores of some episodes, and their optimum.
struct GroupGaps {
  std::vector<double> scores;
  std::vector<double> baselines;  // of the better baseline; infinite if there is none
  std::vector<double> optima;

  TableRow Row(const std::string& name) const {
    const Gaps gaps = GapsOf(scores, optima);
    const double baseline = GapsOf(baselines, optima).mean;
    return {name,
            std::to_string(scores.size()),
            fmt::format("{:.2f} %", gaps.mean),
            fmt::format("{:.2f} %", gaps.median),
            fmt::format("{:.2f} %", gaps.worst),
            std::isfinite(baseline) ? fmt::format("{:.2f} %", baseline) : "-"};
  }
};

OrderedJson ValueJson(const AccountValue& value) {
  return std::visit(
      [](const auto& content) {
        if constexpr (std::is_same_v<decltype(content), const std::monostate&>) {
          return OrderedJson();
        } else {
          return OrderedJson(content);
        }
      },
      value);
}

struct ValueTexts {
  std::string operator()(std::monostate) const { return "-"; }
  std::string operator()(bool value) const { return value ? "yes" : "no"; }
  std::string operator()(int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return fmt::format("{:.6g}", value); }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const std::vector<int64_t>& value) const {
    return fmt::format("{}", fmt::join(value, " "));
  }
};

std::string ValueText(const AccountValue& value) {
  return std::visit(ValueTexts{}, value);
}

/// The rows as lines that begin with `indent`, with columns of at least the given widths.
std::string AlignedTable(const std::vector<TableRow>& rows, std::vector<size_t> widths,
                         const std::vector<bool>& at_right, const std::string& indent) {
  for (const TableRow& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], CharacterCount(row[i]));
    }
  }
  std::string table;
  for (const TableRow& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string padding(i + 1 < row.size() || at_right[i] ? widths[i] - CharacterCount(row[i]) : 0,
                                ' ');
      table += (i == 0 ? indent : "  ") + (at_right[i] ? padding + row[i] : row[i] + padding);
    }
    table += "\n";
  }
  return table;
}

}  // namespace

std::string Label(const Quantity& quantity) {
  return Title(quantity.name) + (quantity.unit.empty() ? "" : " [" + quantity.unit + "]");
}

std::string TableText(const ReportTable& table) {
  std::vector<TableRow> rows = {table.header};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  return AlignedTable(rows, std::vector<size_t>(table.header.size()), NumericColumns(table), "");
}

std::string PercentText(double share) {
  constexpr int kMostDigits = 6;
  std::string text;
  for (int digits = 0; digits <= kMostDigits; ++digits) {
    text = fmt::format("{:.{}f}", 100 * share, digits);
    const double shown = std::stod(text) / 100;
    if ((shown == 0) == (share == 0) && (shown == 1) == (share == 1)) {
      break;
    }
  }
  return text + " %";
}

std::string ProgressLine(const learner_status_t& status, const WorldDescription& world) {
  const std::string score = "greedy " + Title(world.figures.front().name) + " " + GreedyScore(status, world);
  const std::string warning = status.warning.empty() ? "" : "WARNING: " + status.warning + " | ";
  if (status.episodes == status.total_episodes && !status.waiting_for.empty()) {
    return warning + fmt::format("trained, waits for {} | {} episodes | {} updates | {}", status.waiting_for,
                                 status.episodes, status.updates, score);
  }
  const double percent = 100.0 * static_cast<double>(status.episodes) /
                         static_cast<double>(std::max<int64_t>(1, status.total_episodes));
  return warning + fmt::format(
                       "{:3.0f}% | {} of {} episodes | {} updates | epsilon {:.3f} | {} | {:.0f} "
                       "transitions/s | "
                       "{:.0f} updates/s | {} actors{}",
                       percent, status.episodes, status.total_episodes, status.updates, status.epsilon, score,
                       status.transitions_per_s, status.updates_per_s, status.actors,
                       status.waiting_for.empty() ? " | actors wait for the learner"
                                                  : " | learner waits for " + status.waiting_for);
}

std::vector<TableRow> PolicyRows(const std::string& summary_json, const std::string& title) {
  const Json summary = Json::parse(summary_json);
  const std::vector<std::string> names = FigureNames(summary);
  TableRow header = {"policy"};
  std::transform(names.begin(), names.end(), std::back_inserter(header), Title);
  if (summary.contains("gap_percent")) {
    header.push_back("gap");
  }
  header.push_back(Title(summary.at("world").at("success")));
  std::vector<TableRow> rows = {header, FiguresRow(title, summary, summary)};
  for (const Json& baseline : summary.value("baselines", Json::object())) {
    rows.push_back(FiguresRow(baseline.at("title"), baseline, summary));
  }
  if (!summary.value("best_found_" + names.front(), Json()).is_null()) {
    const bool proved = !summary.at("optimal_" + names.front()).is_null();
    rows.push_back(FiguresRow(FoundFlightName(proved), summary, summary, "best_found_"));
  }
  return rows;
}

std::vector<JudgedEpisode> ProvedEpisodes(const std::string& summary_json) {
  const Json summary = Json::parse(summary_json);
  const std::string score = summary.at("world").at("figures").front().at("name");
  std::vector<JudgedEpisode> proved;
  for (const Json& episode : summary.value("judged_episodes", Json::array())) {
    if (episode.at("gap_percent").is_null()) {
      continue;
    }
    double baseline = std::numeric_limits<double>::infinity();
    for (const Json& reached : episode.value("baselines", Json::object())) {
      baseline = std::min(baseline, reached.get<double>());
    }
    proved.push_back(
        {episode.value("group", ""), episode.at(score), episode.at("optimal_" + score), baseline});
  }
  return proved;
}

std::vector<TableRow> GapRows(const std::string& summary_json) {
  std::map<std::pair<size_t, std::string>, GroupGaps>
      groups;  // shorter names first, so "2 ..." before "10 ..."
  GroupGaps all;
  for (const JudgedEpisode& episode : ProvedEpisodes(summary_json)) {
    for (GroupGaps* gaps : {&groups[{episode.group.size(), episode.group}], &all}) {
      gaps->scores.push_back(episode.score);
      gaps->baselines.push_back(episode.better_baseline);
      gaps->optima.push_back(episode.optimal_score);
    }
  }
  if (all.scores.empty()) {
    return {};
  }
  std::vector<TableRow> rows = {{"episodes with", "number", "gap", "median", "worst", "better baseline"}};
  for (const auto& [key, gaps] : groups) {
    if (groups.size() > 1) {
      rows.push_back(gaps.Row(key.second));
    }
  }
  rows.push_back(all.Row("all"));
  return rows;
}

std::string OptimumNote(const std::string& summary_json) {
  const Json summary = Json::parse(summary_json);
  const std::string end = summary.value("optimum_search", SearchEndName(SearchEnd::kOff));
  if (end == SearchEndName(SearchEnd::kFailed)) {
    return "The search for the exact optimum failed; the log says why.";
  }
  if (end == SearchEndName(SearchEnd::kOff) || end == SearchEndName(SearchEnd::kProved)) {
    return "";
  }
  const std::string name = FigureNames(summary).front();
  const Json episodes = summary.value("judged_episodes", Json::array());
  const auto unproved = std::count_if(episodes.begin(), episodes.end(), [](const Json& episode) {
    return episode.at("gap_percent").is_null();
  });
  std::string note = fmt::format("The exact optimum{} is not proved: the search {}",
                                 episodes.empty() ? "" : fmt::format(" of {} episodes", unproved),
                                 end == SearchEndName(SearchEnd::kStopped)
                                     ? "was stopped"
                                     : "reached run.optimum_limit_s or run.optimum_memory_mb");
  if (summary.at("lower_bound_" + name).is_null()) {
    return note + ".";
  }
  const double bound = summary.at("lower_bound_" + name);
  note += fmt::format(". No {} has an {} below {:.3f}", episodes.empty() ? "flight" : "policy", Title(name),
                      bound);
  if (summary.value("success", Json()) == 1) {
    note +=
        fmt::format("; this run lies above the optimum by at most {:.2f} %, which is a bound and not the gap",
                    GapPercent(summary.at("score").get<double>(), bound));
  }
  return note + ".";
}

std::string ResultTable(const std::string& summary_json, const std::string& title) {
  const std::vector<TableRow> rows = PolicyRows(summary_json, title);
  const size_t columns = rows.front().size();
  std::vector<size_t> widths(columns, 10);
  widths.front() = 16;
  std::vector<bool> at_right(columns, true);
  at_right.front() = at_right.back() = false;
  std::string table = AlignedTable(rows, widths, at_right, "  ");
  const std::string note = OptimumNote(summary_json);
  table += note.empty() ? "" : note + "\n";
  if (const std::vector<TableRow> gaps = GapRows(summary_json); !gaps.empty()) {
    table += "\n" + AlignedTable(gaps, {16, 10, 10, 10, 10, 10}, {false, true, true, true, true, true}, "  ");
  }
  return table;
}

std::string EpisodeJson(const EpisodeAccount& account, const std::string& policy,
                        const std::optional<Plan>& plan) {
  OrderedJson json = {{"policy", policy}};
  for (const auto& [name, value] : account.facts) {
    json[name] = ValueJson(value);
  }
  if (plan) {
    json["optimal"] = plan->optimal;
    json["lower_bound_total_aoi"] = plan->lower_bound_total_aoi;
    json["lower_bound_average_aoi"] = plan->lower_bound_average_aoi;
  }
  OrderedJson& steps = json[account.steps_name] = OrderedJson::array();
  for (const std::vector<AccountValue>& row : account.steps) {
    OrderedJson step;
    for (size_t i = 0; i < row.size(); ++i) {
      step[account.columns[i]] = ValueJson(row[i]);
    }
    steps.push_back(std::move(step));
  }
  return json.dump(2);
}

std::string StepTable(const EpisodeAccount& account) {
  std::vector<TableRow> rows = {account.columns};
  for (const std::vector<AccountValue>& values : account.steps) {
    rows.emplace_back();
    std::transform(values.begin(), values.end(), std::back_inserter(rows.back()), ValueText);
  }
  const auto is_number = [](const AccountValue& value) {
    return std::holds_alternative<int64_t>(value) || std::holds_alternative<double>(value);
  };
  std::vector<bool> at_right;
  std::transform(account.steps.front().begin(), account.steps.front().end(), std::back_inserter(at_right),
                 is_number);
  return AlignedTable(rows, std::vector<size_t>(account.columns.size()), at_right, "");
}

}  // namespace fresco
