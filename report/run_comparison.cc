#include "report/run_comparison.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/utf8.h"
#include "msgs/config_reflection.h"
#include "report/drawings.h"
#include "report/mean_estimate.h"
#include "report/result_display.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

constexpr char kSeedField[] = "schedule.seed";
constexpr char kNoValue[] = "-";

using OrderedJson = nlohmann::ordered_json;

RunResult ResultOf(const FinishedRun& run, const Path& folder) {
  try {
    const auto summary = nlohmann::json::parse(run.summary());
    const auto number = [&](const char* name) -> std::optional<double> {
      const auto value = summary.value(name, nlohmann::json());
      return value.is_null() ? std::nullopt : std::optional(value.get<double>());
    };
    return {number("score"),      number("gap_percent"),        number("success"),      summary.at("updates"),
            summary.at("wall_s"), summary.at("weights_crc32c"), summary.at("completed")};
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(fmt::format("{}: expected the summary of a run as the learner writes it; {}",
                                 (folder / "summary.json").string(), error.what()));
  }
}

/// The numbers of these runs; empty unless each has one, since means over different runs can't be compared.
std::vector<double> Sample(const std::vector<const ComparedRun*>& runs,
                           std::optional<double> RunResult::*number) {
  std::vector<double> sample;
  for (const ComparedRun* compared : runs) {
    if (const std::optional<double> value = compared->result.*number) {
      sample.push_back(*value);
    }
  }
  return sample.size() == runs.size() ? sample : std::vector<double>();
}

/// A long text is cut.
std::string CellText(const std::string& value) {
  constexpr size_t kLongest = 60;
  return CharacterCount(value) > kLongest ? std::string(FirstCharacters(value, kLongest)) + "..." : value;
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

std::vector<std::vector<const ComparedRun*>> RunComparison::SeedGroups() const {
  using FieldMap = std::map<std::string, std::string>;
  std::map<FieldMap, std::map<std::string, const ComparedRun*>> groups;  // by settings, then by seed
  std::vector<FieldMap> order;
  for (const ComparedRun& compared : runs_) {
    const RunResult& result = compared.result;
    if (!result.completed || !result.score || !(result.success > 0)) {
      continue;
    }
    FieldMap settings = compared.settings;
    const std::string seed = settings.extract(kSeedField).mapped();
    // Actors, addresses and limits do not decide the weights.
    std::erase_if(settings, [](const auto& setting) { return setting.first.starts_with("run."); });
    if (!groups.contains(settings)) {
      order.push_back(settings);
    }
    groups[settings].emplace(seed, &compared);
  }
  std::vector<std::vector<const ComparedRun*>> several;
  for (const FieldMap& settings : order) {
    if (groups[settings].size() > 1) {
      several.emplace_back();
      for (const auto& [seed, compared] : groups[settings]) {
        several.back().push_back(compared);
      }
    }
  }
  return several;
}

ReportTable RunComparison::ResultTable() const {
  ReportTable table{
      "Results",
      {"run", Label(world().figures.front()), "gap", Title(world().success), "updates", "time", "weights"},
      {}};
  for (const ComparedRun& compared : runs_) {
    const RunResult& result = compared.result;
    table.rows.push_back({compared.name, result.score ? fmt::format("{:.3f}", *result.score) : kNoValue,
                          result.gap_percent ? fmt::format("{:.2f} %", *result.gap_percent) : kNoValue,
                          result.success ? PercentText(*result.success) : kNoValue,
                          std::to_string(result.updates),
                          fmt::format("{:.{}f} s", result.wall_s, result.wall_s < 10 ? 1 : 0),
                          result.weights_crc32c + (result.completed ? "" : " (interrupted)")});
  }
  return table;
}

ReportTable RunComparison::SeedTable() const {
  ReportTable table{"Means, with half of their 95 % intervals",
                    {"runs that differ in the seed alone", "seeds", Label(world().figures.front()), "gap"},
                    {}};
  for (const std::vector<const ComparedRun*>& members : SeedGroups()) {
    std::vector<std::string> names;
    for (const ComparedRun* compared : members) {
      names.push_back(compared->name);
    }
    table.rows.push_back({fmt::format("{}", fmt::join(names, ", ")), std::to_string(members.size()),
                          EstimateText(Sample(members, &RunResult::score), ""),
                          EstimateText(Sample(members, &RunResult::gap_percent), " %")});
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
      table.rows.back().push_back(found == compared.settings.end() ? kNoValue : CellText(found->second));
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
  OrderedJson json = {{"world", world_name()}};
  for (const ComparedRun& compared : runs_) {
    OrderedJson run = OrderedJson::parse(compared.run->summary());
    run.erase("judged_episodes");
    run.erase("world");
    OrderedJson named = {{"run", compared.name}};
    named.update(run);
    json["runs"].push_back(named);
  }
  json["seeds"] = OrderedJson::array();
  for (const std::vector<const ComparedRun*>& members : SeedGroups()) {
    OrderedJson group;
    for (const ComparedRun* compared : members) {
      group["runs"].push_back(compared->name);
    }
    const MeanEstimate estimate = EstimateMean(Sample(members, &RunResult::score));
    group["score"] = estimate.mean;
    group["score_half_width"] = estimate.half_width.value();
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
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace);
}

LinePlot RunComparison::CurvesPlot() const {
  std::vector<LearningCurve> curves;
  for (const ComparedRun& compared : runs_) {
    curves.push_back(compared.run->learning_curve());
    curves.back().title = compared.name;
  }
  return BestSoFarPlot(curves);
}

std::vector<ReportEpisode> RunComparison::Episodes() const {
  std::vector<ReportEpisode> episodes;
  const std::optional<uint64_t> seed = runs_.front().run->ShownSeed();
  if (!seed || !OneWorld() || DrawingOf(first_world()) == nullptr) {
    return episodes;
  }
  for (const ComparedRun& compared : runs_) {
    try {
      if (std::optional<Episode> episode = compared.run->FlyBest(*seed)) {
        episodes.push_back({compared.name, *std::move(episode)});
      }
    } catch (const Error& error) {
      spdlog::warn("the page has no flight of {}: {}", compared.name, error.what());
    }
  }
  for (ReportEpisode& episode : runs_.front().run->FlyReferences(*seed)) {
    episodes.push_back(std::move(episode));
  }
  return episodes;
}

std::vector<RunComparison> CompareRuns(const std::vector<Path>& folders) {
  std::vector<Path> ended;
  std::set<Path> known;
  for (const Path& folder : folders) {
    std::error_code error;
    if (!known.insert(std::filesystem::weakly_canonical(folder, error)).second) {
      spdlog::warn("{} is named twice", folder.string());
    } else if (const std::string reason = FinishedRun::WhyNone(folder); !reason.empty()) {
      if (folders.size() == 1) {
        throw UsageError(reason);
      }
      spdlog::warn("left out: {}", reason);
    } else {
      ended.push_back(folder);
    }
  }
  if (ended.empty()) {
    throw UsageError("none of the folders is of a run that has ended; a training makes one: fresco train");
  }
  const std::vector<std::string> names = NamesOf(ended);
  std::map<std::string, std::vector<ComparedRun>> by_kind;
  std::vector<std::string> kinds;  // in the order of the folders
  for (size_t i = 0; i < ended.size(); ++i) {
    auto run = std::make_shared<const FinishedRun>(ended[i]);
    const WorldDescription& world = run->world().description();
    const std::string kind =
        fmt::format("{}: {}, {}", world.name, Label(world.figures.front()), world.success);
    RunResult result = ResultOf(*run, ended[i]);
    auto settings = FieldValues(run->experiment().config());
    if (!by_kind.contains(kind)) {
      kinds.push_back(kind);
    }
    by_kind[kind].push_back({Printable(names[i]), std::move(run), std::move(result), std::move(settings)});
  }
  std::vector<RunComparison> comparisons;
  for (const std::string& kind : kinds) {
    comparisons.emplace_back(std::move(by_kind[kind]));
  }
  return comparisons;
}

void WriteComparisonPage(const std::vector<RunComparison>& comparisons, const Path& file) {
  ReportContents contents;
  contents.title = "Fresco: runs compared";
  for (const RunComparison& comparison : comparisons) {
    const std::string prefix = comparisons.size() > 1 ? comparison.world_name() + ": " : "";
    for (ReportTable& table : comparison.Tables()) {
      table.title = prefix + table.title;
      contents.tables.push_back(std::move(table));
    }
    if (const LinePlot plot = comparison.CurvesPlot(); !plot.curves.empty()) {
      try {
        contents.figures.push_back({prefix + "Learning curves", "The best evaluation so far of each run.",
                                    SvgText(DrawLinePlot(plot))});
      } catch (const Error& error) {
        spdlog::warn("{} has no learning curves: {}", file.string(), error.what());
      }
    }
    if (contents.episodes.empty()) {
      contents.episodes = comparison.Episodes();
      contents.world = &comparison.first_world();
    }
  }
  WriteFileAtomically(file, ReportPage(contents));
}

}  // namespace fresco
