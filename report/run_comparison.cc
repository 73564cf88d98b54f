#include "report/run_comparison.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "msgs/config_reflection.h"
#include "report/drawings.h"
#include "report/mean_estimate.h"
#include "report/result_display.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

constexpr char kSeedField[] = "schedule.seed";
constexpr char kNoValue[] = "-";

/// Numbers of a run's summary.
struct RunResult {
  std::optional<double> score;
  std::optional<double> gap_percent;
  std::optional<double> success;
  int64_t updates = 0;
  double wall_s = 0;
  std::string weights_crc32c;
  bool completed = true;
};

RunResult ResultIn(const std::string& summary_json) {
  const auto summary = nlohmann::json::parse(summary_json);
  const auto number = [&](const char* name) -> std::optional<double> {
    const auto value = summary.value(name, nlohmann::json());
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
  };
  return {number("score"),      number("gap_percent"),        number("success"),      summary.at("updates"),
          summary.at("wall_s"), summary.at("weights_crc32c"), summary.at("completed")};
}

std::string ScoreLabel(const WorldDescription& world) {
  const Quantity& figure = world.figures.front();
  return Title(figure.name) + (figure.unit.empty() ? "" : " [" + figure.unit + "]");
}

std::string EstimateText(const std::vector<double>& sample, const std::string& unit) {
  if (sample.empty()) {
    return kNoValue;
  }
  const MeanEstimate estimate = EstimateMean(sample);
  return fmt::format("{:.3f}{}{}", estimate.mean,
                     estimate.half_width ? fmt::format(" ± {:.3f}", *estimate.half_width) : "", unit);
}

/// What runs are called: their folder's name, or as much of the path as makes the names different.
std::vector<std::string> NamesOf(const std::vector<Path>& folders) {
  std::vector<std::string> names;
  for (const Path& folder : folders) {
    const Path path = folder.filename().empty() ? folder.parent_path() : folder;
    names.push_back(path.filename().string());
  }
  if (std::set<std::string>(names.begin(), names.end()).size() < names.size()) {
    std::transform(folders.begin(), folders.end(), names.begin(),
                   [](const Path& folder) { return folder.string(); });
  }
  return names;
}

}  // namespace

RunComparison::RunComparison(const std::vector<Path>& folders) {
  FRESCO_CHECK(!folders.empty());
  const std::vector<std::string> names = NamesOf(folders);
  for (size_t i = 0; i < folders.size(); ++i) {
    auto run = std::make_unique<FinishedRun>(folders[i]);
    auto settings = FieldValues(run->experiment().config());
    runs_.push_back({names[i], std::move(run), std::move(settings)});
    const std::string expected = ScoreLabel(world());
    const std::string found = ScoreLabel(runs_.back().run->world().description());
    if (found != expected) {
      throw UsageError(fmt::format(
          "expected runs that are judged by the same figure; {} is judged by its {}, but {} by its {}",
          folders.front().string(), expected, folders[i].string(), found));
    }
  }
}

bool RunComparison::OneWorld() const {
  return std::all_of(runs_.begin(), runs_.end(), [&](const ComparedRun& compared) {
    return compared.run->experiment().WorldText() == runs_.front().run->experiment().WorldText();
  });
}

std::vector<std::string> RunComparison::DifferentFields() const {
  std::set<std::string> paths;
  for (const ComparedRun& compared : runs_) {
    for (const auto& [path, value] : compared.settings) {
      paths.insert(path);
    }
  }
  std::erase_if(paths, [&](const std::string& path) {
    const auto value = [&](const ComparedRun& compared) {
      const auto found = compared.settings.find(path);
      return found == compared.settings.end() ? std::nullopt : std::optional(found->second);
    };
    return std::all_of(runs_.begin(), runs_.end(),
                       [&](const ComparedRun& compared) { return value(compared) == value(runs_.front()); });
  });
  return {paths.begin(), paths.end()};
}

std::vector<std::vector<size_t>> RunComparison::SeedGroups() const {
  std::map<std::map<std::string, std::string>, std::vector<size_t>> groups;
  for (size_t i = 0; i < runs_.size(); ++i) {
    std::map<std::string, std::string> settings = runs_[i].settings;
    settings.erase(kSeedField);
    // Actors, addresses and limits do not decide the weights.
    std::erase_if(settings, [](const auto& setting) { return setting.first.starts_with("run."); });
    groups[settings].push_back(i);
  }
  std::vector<std::vector<size_t>> several;
  for (const auto& [settings, members] : groups) {
    std::set<std::string> seeds;
    for (const size_t i : members) {
      seeds.insert(runs_[i].settings.at(kSeedField));
    }
    if (members.size() > 1 && seeds.size() == members.size()) {
      several.push_back(members);
    }
  }
  std::sort(several.begin(), several.end());
  return several;
}

ReportTable RunComparison::ResultTable() const {
  ReportTable table{"Results",
                    {"run", ScoreLabel(world()), "gap", Title(world().success), "updates", "time", "weights"},
                    {}};
  for (const ComparedRun& compared : runs_) {
    const RunResult result = ResultIn(compared.run->summary());
    table.rows.push_back({compared.name, result.score ? fmt::format("{:.3f}", *result.score) : kNoValue,
                          result.gap_percent ? fmt::format("{:.2f} %", *result.gap_percent) : kNoValue,
                          result.success ? PercentText(*result.success) : kNoValue,
                          std::to_string(result.updates), fmt::format("{:.{}f} s", result.wall_s, result.wall_s < 10 ? 1 : 0),
                          result.weights_crc32c + (result.completed ? "" : " (interrupted)")});
  }
  return table;
}

ReportTable RunComparison::SeedTable() const {
  ReportTable table{"Means, with half of their 95 % intervals",
                    {"runs that differ in the seed alone", "seeds", ScoreLabel(world()), "gap"},
                    {}};
  for (const std::vector<size_t>& members : SeedGroups()) {
    std::vector<std::string> names;
    std::vector<double> scores;
    std::vector<double> gaps;
    for (const size_t i : members) {
      const RunResult result = ResultIn(runs_[i].run->summary());
      names.push_back(runs_[i].name);
      if (result.score) {
        scores.push_back(*result.score);
      }
      if (result.gap_percent) {
        gaps.push_back(*result.gap_percent);
      }
    }
    table.rows.push_back({fmt::format("{}", fmt::join(names, ", ")), std::to_string(members.size()),
                          EstimateText(scores, ""), EstimateText(gaps, " %")});
  }
  return table;
}

ReportTable RunComparison::SettingTable() const {
  ReportTable table{"Settings that differ", {"setting"}, {}};
  for (const ComparedRun& compared : runs_) {
    table.header.push_back(compared.name);
  }
  for (const std::string& path : DifferentFields()) {
    table.rows.push_back({path});
    for (const ComparedRun& compared : runs_) {
      const auto found = compared.settings.find(path);
      table.rows.back().push_back(found == compared.settings.end() ? kNoValue : found->second);
    }
  }
  return table;
}

std::vector<ReportTable> RunComparison::Tables() const {
  std::vector<ReportTable> tables = {ResultTable(), SeedTable(), SettingTable()};
  std::erase_if(tables, [](const ReportTable& table) { return table.rows.empty(); });
  return tables;
}

std::string RunComparison::Text() const {
  std::string text;
  for (const ReportTable& table : Tables()) {
    text += (text.empty() ? "" : "\n" + table.title + "\n") + TableText(table);
  }
  return text;
}

std::string RunComparison::Json() const {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson json;
  for (const ComparedRun& compared : runs_) {
    OrderedJson run = OrderedJson::parse(compared.run->summary());
    run.erase("judged_episodes");
    run.erase("world");
    OrderedJson named = {{"run", compared.name}};
    named.update(run);
    json["runs"].push_back(named);
  }
  json["seeds"] = OrderedJson::array();
  for (const std::vector<size_t>& members : SeedGroups()) {
    OrderedJson group;
    std::vector<double> scores;
    for (const size_t i : members) {
      group["runs"].push_back(runs_[i].name);
      if (const auto score = ResultIn(runs_[i].run->summary()).score) {
        scores.push_back(*score);
      }
    }
    if (!scores.empty()) {
      const MeanEstimate estimate = EstimateMean(scores);
      group["score"] = estimate.mean;
      group["score_half_width"] = estimate.half_width ? OrderedJson(*estimate.half_width) : OrderedJson();
    }
    json["seeds"].push_back(group);
  }
  json["settings"] = OrderedJson::object();
  for (const std::string& path : DifferentFields()) {
    for (const ComparedRun& compared : runs_) {
      const auto found = compared.settings.find(path);
      json["settings"][path].push_back(found == compared.settings.end() ? OrderedJson()
                                                                        : OrderedJson(found->second));
    }
  }
  return json.dump(2);
}

LinePlot RunComparison::CurvesPlot() const {
  std::vector<LearningCurve> curves;
  for (const ComparedRun& compared : runs_) {
    if (!compared.run->learning_curve().points.empty()) {
      curves.push_back(compared.run->learning_curve());
      curves.back().title = compared.name;
    }
  }
  return curves.empty() ? LinePlot() : BestSoFarPlot(curves, OneWorld());
}

void RunComparison::WritePage(const Path& file) const {
  ReportContents contents;
  contents.title = fmt::format("Fresco: {} runs compared", runs_.size());
  contents.tables = Tables();
  if (const LinePlot plot = CurvesPlot(); !plot.curves.empty()) {
    try {
      contents.figures.push_back(
          {"Learning curves", "The best evaluation so far of each run.", SvgText(DrawLinePlot(plot))});
    } catch (const Error& error) {
      spdlog::warn("{} has no learning curves: {}", file.string(), error.what());
    }
  }
  if (OneWorld() && DrawingOf(runs_.front().run->world()) != nullptr) {
    contents.world = &runs_.front().run->world();
    for (const ComparedRun& compared : runs_) {
      if (std::optional<Episode> episode = compared.run->FlyBest()) {
        contents.episodes.push_back({compared.name, *std::move(episode)});
      }
    }
    for (ReportEpisode& episode : runs_.front().run->FlyReferences()) {
      contents.episodes.push_back(std::move(episode));
    }
  }
  WriteFileAtomically(file, ReportPage(contents));
}

}  // namespace fresco
