// The rows of `fresco bench`: what is measured, beside what, and how they are printed and checked. Pure
// functions but for MeasureRows, which calls the subjects. Used by the main thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fresco {

/// A quantity beside its roof, its peer or its limit.
struct Row {
  std::string name;
  double value = 0;
  std::string unit;
  std::string reference;       ///< what the other value is
  double reference_value = 0;  ///< in the same unit
  double ratio = 0;            ///< how near the value is to its reference; more is better
};

/// The ratio is value / reference.
Row MoreIsBetter(std::string name, double value, std::string unit, std::string reference,
                 double reference_value);
/// The ratio is reference / value.
Row LessIsBetter(std::string name, double value, std::string unit, std::string reference,
                 double reference_value);

/// A row that can't be measured here, and why.
struct AbsentRow {
  std::string name;
  std::string reason;
};

struct Results {
  std::vector<Row> rows;
  std::vector<AbsentRow> absent;
};

/// Rows that are measured together.
struct Subject {
  std::vector<std::string> names;
  /// Measures each row for about `seconds`. Results has every one of `names`.
  std::function<Results(double seconds)> measure;
};

/// For a subject of which nothing can be measured here.
Results AllAbsent(const std::vector<std::string>& names, const std::string& reason);

/// Where and with what the rows were measured.
struct BenchHead {
  std::string processor;
  int cores = 0;
  std::string arithmetic;
  std::string compiler;  ///< with its flags
  std::string commit;
};

/// The names of all rows that have a match of the regular expression `filter`. Throws UsageError if it is
/// none, or no name has one.
std::vector<std::string> SelectRows(const std::vector<Subject>& subjects, const std::string& filter);

/// Called before each subject: the names of its rows, how many subjects are done, how many are measured.
using BenchProgress = std::function<void(const std::string& names, size_t done, size_t all)>;

/// Measures the rows with these names.
Results MeasureRows(const std::vector<Subject>& subjects, const std::vector<std::string>& names,
                    double seconds, const BenchProgress& progress);

/// A table for people, with the head above it and the absent rows below.
std::string BenchTable(const BenchHead& head, const Results& results);

/// The JSON object: `machine` (an object), `commit`, `rows` and `absent`.
std::string BenchJson(const BenchHead& head, const Results& results);

/// What BenchJson says of an earlier measurement.
struct RecordedRatios {
  std::string processor;
  std::string arithmetic;
  std::vector<std::pair<std::string, double>> ratios;  ///< names of rows and their ratios
};

/// Reads the JSON of BenchJson. Throws UsageError, naming `origin`, if a member that is read is missing or
/// names a row that no subject has.
RecordedRatios ReadRecordedRatios(const std::string& text, const std::string& origin,
                                  const std::vector<Subject>& subjects);

/// A row that is absent, or whose ratio is below 80 % of the recorded one.
struct FallenRow {
  std::string name;
  std::string reason;
};

/// The rows among `results` that have fallen.
std::vector<FallenRow> FallenRows(const RecordedRatios& recorded, const Results& results);

}  // namespace fresco
