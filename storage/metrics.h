// Further forms of a run's metrics.csv, for other tools. Also reads it. Pure functions; any thread may call
// them.
#pragma once

#include <string>
#include <vector>

namespace fresco {

/// The numbers of a metrics.csv, and the names of its columns.
struct MetricsTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;

  /// The index of a column. Throws UsageError if there is none of this name.
  size_t ColumnOf(const std::string& name) const;
};

/// Reads a metrics.csv. Throws UsageError if it is not one.
MetricsTable ParseMetrics(const std::string& metrics_csv);

/// The number of columns of metrics.csv, from the first on, that tell of the training; the rest tells of the
/// evaluation.
inline constexpr int kTrainingColumns = 8;

/// metrics.csv as one JSON object a line, with the names of the columns.
std::string MetricsJsonLines(const std::string& metrics_csv);

/// metrics.csv as the content of a TensorBoard event file: curves over the updates, "training/loss" or
/// "evaluation/average_aoi". `begin_s`: when the training began, seconds since the epoch. Each record is its
/// length, the length's CRC, an event (tensorboard.proto) and its CRC; CRCs are CRC-32C, rotated and added to
/// as TensorFlow does ("masked"), and numbers are little-endian.
std::string TensorBoardEvents(const std::string& metrics_csv, double begin_s);

}  // namespace fresco
