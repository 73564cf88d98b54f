#include "tests/bench/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

#include "core/error.h"
#include "tests/bench/stop.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> NamesOf(const std::vector<Subject>& subjects) {
  std::vector<std::string> names;
  for (const Subject& subject : subjects) {
    names.insert(names.end(), subject.names.begin(), subject.names.end());
  }
  return names;
}

/// Four significant digits, without an exponent.
std::string Digits(double value) {
  const double size = std::abs(value);
  const int decimals = size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : 3;
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

Row MoreIsBetter(std::string name, double value, std::string unit, std::string reference,
                 double reference_value) {
  return {std::move(name),      value,           std::move(unit),
          std::move(reference), reference_value, value / reference_value};
}

Row LessIsBetter(std::string name, double value, std::string unit, std::string reference,
                 double reference_value) {
  return {std::move(name),      value,           std::move(unit),
          std::move(reference), reference_value, reference_value / value};
}

Results AllAbsent(const std::vector<std::string>& names, const std::string& reason) {
  Results results;
  for (const std::string& name : names) {
    results.absent.push_back({name, reason});
  }
  return results;
}

std::vector<std::string> SelectRows(const std::vector<Subject>& subjects, const std::string& filter) {
  const std::vector<std::string> all = NamesOf(subjects);
  std::vector<std::string> selected;
  try {
    const std::regex expression(filter);
    std::copy_if(all.begin(), all.end(), std::back_inserter(selected),
                 [&](const std::string& name) { return std::regex_search(name, expression); });
  } catch (const std::regex_error& error) {
    throw UsageError(
        fmt::format("--filter: expected a regular expression, found \"{}\": {}", filter, error.what()));
  }
  if (selected.empty()) {
    throw UsageError(
        fmt::format("--filter: no row's name matches \"{}\"; the rows are {}", filter, fmt::join(all, ", ")));
  }
  return selected;
}

Results MeasureRows(const std::vector<Subject>& subjects, const std::vector<std::string>& names,
                    double seconds, const BenchProgress& progress) {
  const auto wanted_of = [&](const Subject& subject) {
    std::vector<std::string> wanted;
    std::copy_if(subject.names.begin(), subject.names.end(), std::back_inserter(wanted),
                 [&](const std::string& name) { return Has(names, name); });
    return wanted;
  };
  const auto measured = static_cast<size_t>(std::count_if(
      subjects.begin(), subjects.end(), [&](const Subject& subject) { return !wanted_of(subject).empty(); }));
  Results all;
  size_t done = 0;
  for (const Subject& subject : subjects) {
    const std::vector<std::string> wanted = wanted_of(subject);
    if (wanted.empty()) {
      continue;
    }
    ThrowIfStopped();
    progress(fmt::format("{}", fmt::join(wanted, ", ")), done++, measured);
    const Results results = subject.measure(seconds);
    FRESCO_CHECK(results.rows.size() + results.absent.size() == subject.names.size());
    std::copy_if(results.rows.begin(), results.rows.end(), std::back_inserter(all.rows),
                 [&](const Row& row) { return Has(wanted, row.name); });
    std::copy_if(results.absent.begin(), results.absent.end(), std::back_inserter(all.absent),
                 [&](const AbsentRow& row) { return Has(wanted, row.name); });
  }
  return all;
}

std::string BenchTable(const BenchHead& head, const Results& results) {
  std::string text = fmt::format("machine   {}, {} cores, {}\ncompiler  {}\ncommit    {}\n\n", head.processor,
                                 head.cores, head.arithmetic, head.compiler, head.commit);
  size_t name_width = 3;
  size_t unit_width = 4;
  for (const Row& row : results.rows) {
    name_width = std::max(name_width, row.name.size());
    unit_width = std::max(unit_width, row.unit.size());
  }
  const auto line = [&](const auto& name, const auto& value, const auto& unit, const auto& reference_value,
                        const auto& ratio, const auto& reference) {
    text += fmt::format("{:<{}}  {:>10}  {:<{}}  {:>10}  {:>6}  {}\n", name, name_width, value, unit,
                        unit_width, reference_value, ratio, reference);
  };
  line("row", "value", "unit", "reference", "ratio", "the reference is");
  for (const Row& row : results.rows) {
    line(row.name, Digits(row.value), row.unit, Digits(row.reference_value), fmt::format("{:.3f}", row.ratio),
         row.reference);
  }
  for (const AbsentRow& row : results.absent) {
    text += fmt::format("{:<{}}  absent: {}\n", row.name, name_width, row.reason);
  }
  return text;
}

std::string BenchJson(const BenchHead& head, const Results& results) {
  OrderedJson json;
  json["machine"] = {{"processor", head.processor},
                     {"cores", head.cores},
                     {"arithmetic", head.arithmetic},
                     {"compiler", head.compiler}};
  json["commit"] = head.commit;
  json["rows"] = OrderedJson::array();
  for (const Row& row : results.rows) {
    json["rows"].push_back({{"name", row.name},
                            {"value", row.value},
                            {"unit", row.unit},
                            {"reference", row.reference},
                            {"reference_value", row.reference_value},
                            {"ratio", row.ratio}});
  }
  json["absent"] = OrderedJson::array();
  for (const AbsentRow& row : results.absent) {
    json["absent"].push_back({{"name", row.name}, {"reason", row.reason}});
  }
  return json.dump(2);
}

RecordedRatios ReadRecordedRatios(const std::string& text, const std::string& origin,
                                  const std::vector<Subject>& subjects) {
  const std::vector<std::string> names = NamesOf(subjects);
  const auto json = OrderedJson::parse(text, nullptr, false);
  const auto is_text = [](const OrderedJson& object, const char* name) {
    return object.is_object() && object.contains(name) && object[name].is_string();
  };
  const bool has_machine = json.is_object() && json.contains("machine") &&
                           is_text(json["machine"], "processor") && is_text(json["machine"], "arithmetic");
  Expect(has_machine && json.contains("rows") && json["rows"].is_array(), origin,
         "expected what `fresco bench --format json` prints");
  RecordedRatios recorded{json["machine"]["processor"], json["machine"]["arithmetic"], {}};
  for (const auto& row : json["rows"]) {
    Expect(is_text(row, "name"), origin, "expected a name in each of `rows`");
    const std::string name = row["name"];
    Expect(Has(names, name), origin, fmt::format("there is no row \"{}\"{}", name, DidYouMean(name, names)));
    const OrderedJson ratio = row.value("ratio", OrderedJson());
    Expect(ratio.is_number() && ratio.get<double>() > 0, origin,
           fmt::format("{}: expected a ratio above 0, found {}", name, ratio.dump()));
    recorded.ratios.emplace_back(name, ratio.get<double>());
  }
  return recorded;
}

std::vector<FallenRow> FallenRows(const RecordedRatios& recorded, const Results& results) {
  constexpr double kLeastShare = 0.8;
  std::vector<FallenRow> fallen;
  for (const auto& [name, ratio] : recorded.ratios) {
    for (const Row& row : results.rows) {
      if (row.name == name && !(row.ratio >= kLeastShare * ratio)) {
        fallen.push_back({name, fmt::format("the ratio is {:.3f}, below {:.0f} % of the recorded {:.3f}",
                                            row.ratio, 100 * kLeastShare, ratio)});
      }
    }
    for (const AbsentRow& row : results.absent) {
      if (row.name == name) {
        fallen.push_back({name, fmt::format("absent: {}; a ratio is recorded", row.reason)});
      }
    }
  }
  return fallen;
}

}  // namespace fresco
