#include "worlds/uav/obstacle_map.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/error.h"

namespace fresco {
namespace {

constexpr std::array kNeighbours = {Cell{0, 1}, Cell{0, -1}, Cell{1, 0}, Cell{-1, 0}};
constexpr char kKinds[] = ".NRBS";
constexpr int64_t kParts = 1 << 16;  // of a cell, to which HasLineOfSight rounds

/// Where a line begins and ends, in parts of a cell.
struct Line {
  int64_t x = 0;
  int64_t y = 0;
  int64_t end_x = 0;
  int64_t end_y = 0;
};

int64_t InParts(double position_m, double cell_m) {
  return static_cast<int64_t>(std::floor(position_m / cell_m * kParts + 0.5));
}

/// Rounds towards minus infinity; `b` is positive.
int64_t FloorOfQuotient(int64_t a, int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

/// The column or row of a place; on an edge, the lower one.
int IndexInParts(int64_t position, int cells) {
  return static_cast<int>(
      std::clamp<int64_t>(FloorOfQuotient(position + kParts / 2 - 1, kParts), 0, cells - 1));
}

/// Calls `visit(row)` for each row whose cells' inside holds points with a y strictly between low / scale and
/// high / scale, or, if both are equal, with this y. Returns whether some call was true. `scale` is positive.
template <class Visit>
bool AnyRow(int64_t low, int64_t high, int64_t scale, const Visit& visit) {
  const int64_t cell = kParts * scale;
  // The inside of row j reaches from (j - 1/2) to (j + 1/2).
  int64_t first = FloorOfQuotient(low + cell / 2, cell);
  int64_t last = FloorOfQuotient(high + cell / 2, cell);
  if (low < high && last * cell - cell / 2 == high) {
    --last;  // the line ends at its southern edge
  }
  if (low == high && first * cell - cell / 2 == low) {
    return false;  // along an edge
  }
  for (; first <= last; ++first) {
    if (visit(static_cast<int>(first))) {
      return true;
    }
  }
  return false;
}

/// Calls `visit(cell)` for the cells through whose inside the line goes, until it returns true. Returns
/// whether it did. The line begins in the centre of a cell.
template <class Visit>
bool AnyCellOnLine(const Line& line, const Visit& visit) {
  constexpr int64_t kHalf = kParts / 2;
  const int64_t west = std::min(line.x, line.end_x);
  const int64_t east = std::max(line.x, line.end_x);
  if (west == east) {
    const auto column = static_cast<int>(line.x / kParts);
    return AnyRow(std::min(line.y, line.end_y), std::max(line.y, line.end_y), 1, [&](int row) {
      return visit(Cell{column, row});
    });
  }
  // The line's height, times its width.
  const int64_t width = line.end_x - line.x;
  const auto scaled_y = [&](int64_t x) {
    const int64_t y = line.y * width + (line.end_y - line.y) * (x - line.x);
    return width > 0 ? y : -y;
  };
  const auto first = static_cast<int>(FloorOfQuotient(west + kHalf, kParts));
  const auto last = static_cast<int>(FloorOfQuotient(east + kHalf - 1, kParts));
  for (int column = first; column <= last; ++column) {
    const int64_t at_west = scaled_y(std::max(west, column * kParts - kHalf));
    const int64_t at_east = scaled_y(std::min(east, column * kParts + kHalf));
    if (AnyRow(std::min(at_west, at_east), std::max(at_west, at_east), east - west, [&](int row) {
          return visit(Cell{column, row});
        })) {
      return true;
    }
  }
  return false;
}

const std::vector<std::string>& CheckedRows(const std::vector<std::string>& rows) {
  ObstacleMap::CheckRows(rows);
  return rows;
}

}  // namespace

void ObstacleMap::CheckRows(const std::vector<std::string>& rows) {
  if (rows.empty() || rows[0].empty()) {
    throw UsageError(
        "scenario.map_row: the map has no cells; allowed: at least one row of at least one cell");
  }
  const size_t columns = rows[0].size();
  if (columns > kMaximumMapCells || rows.size() * columns > kMaximumMapCells) {
    throw UsageError(
        fmt::format("scenario.map_row: {} x {} cells are too many; allowed: a product of at most {}", columns,
                    rows.size(), kMaximumMapCells));
  }
  for (size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != columns) {
      throw UsageError(
          fmt::format("scenario.map_row[{}]: {} cells; allowed: {}, as many as the first row has", i,
                      rows[i].size(), columns));
    }
    const size_t at = rows[i].find_first_not_of(kKinds);
    if (at != std::string::npos) {
      throw UsageError(
          fmt::format("scenario.map_row[{}]: \"{}\" has '{}' in column {}; allowed: '.' (free), 'N' (no "
                      "flying), 'R' (blocks "
                      "radio), 'B' (both), 'S' (start and landing)",
                      i, rows[i], rows[i][at], at));
    }
  }
}

std::vector<Cell> ObstacleMap::ZonesIn(const std::vector<std::string>& rows) {
  std::vector<Cell> zones;
  const auto count = static_cast<int>(rows.size());
  for (int row = 0; row < count; ++row) {
    const std::string& text = rows[static_cast<size_t>(count - 1 - row)];
    for (size_t column = 0; column < text.size(); ++column) {
      if (text[column] == static_cast<char>(CellKind::kStartAndLanding)) {
        zones.push_back({static_cast<int>(column), row});
      }
    }
  }
  return zones;
}

ObstacleMap::ObstacleMap(const std::vector<std::string>& rows)
    : columns_(static_cast<int>(CheckedRows(rows)[0].size())),
      rows_(static_cast<int>(rows.size())),
      zones_(ZonesIn(rows)) {
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char character : *row) {
      const auto kind = static_cast<CellKind>(character);
      kinds_.push_back(kind);
      may_fly_.push_back(kind != CellKind::kNoFlying && kind != CellKind::kBlocksBoth);
    }
  }
  distances_.assign(kinds_.size() * kinds_.size(), kCutOff);
  component_of_.assign(kinds_.size(), 0);
  components_.resize(1);
  std::vector<Cell> reached;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Cell cell = {column, row};
      if (!MayFly(cell)) {
        continue;
      }
      TabulateDistances(cell, reached);
      if (component_of_[IndexOf(cell)] == 0) {
        std::sort(reached.begin(), reached.end(), [&](Cell a, Cell b) { return IndexOf(a) < IndexOf(b); });
        for (const Cell other : reached) {
          component_of_[IndexOf(other)] = static_cast<int16_t>(components_.size());
        }
        components_.push_back(reached);
      }
    }
  }
}

// A breadth-first search. Writes the cells that it reaches to `reached`.
void ObstacleMap::TabulateDistances(Cell from, std::vector<Cell>& reached) {
  int16_t* distances = distances_.data() + IndexOf(from) * kinds_.size();
  distances[IndexOf(from)] = 0;
  reached = {from};
  for (size_t i = 0; i < reached.size(); ++i) {
    const Cell cell = reached[i];
    const int farther = distances[IndexOf(cell)] + 1;
    for (const Cell step : kNeighbours) {
      const Cell next = {cell.column + step.column, cell.row + step.row};
      if (MayFly(next) && distances[IndexOf(next)] > farther) {
        distances[IndexOf(next)] = static_cast<int16_t>(farther);
        reached.push_back(next);
      }
    }
  }
}

std::vector<std::string> ObstacleMap::Text() const {
  std::vector<std::string> text;
  for (int row = rows_ - 1; row >= 0; --row) {
    std::string& line = text.emplace_back();
    for (int column = 0; column < columns_; ++column) {
      line.push_back(static_cast<char>(KindOf({column, row})));
    }
  }
  return text;
}

int64_t ObstacleMap::bytes() const {
  const size_t cells = kinds_.size();
  return static_cast<int64_t>(distances_.size() * sizeof(int16_t) + zones_.size() * sizeof(Cell) +
                              components_.size() * sizeof(components_[0]) +
                              cells * (sizeof(CellKind) + sizeof(uint8_t) + sizeof(int16_t) + sizeof(Cell)));
}

bool ObstacleMap::HasLineOfSight(Cell cell, const Sensor& sensor, double cell_m) const {
  const Line line = {cell.column * kParts, cell.row * kParts, InParts(sensor.x_m, cell_m),
                     InParts(sensor.y_m, cell_m)};
  const Cell stands_in = {IndexInParts(line.end_x, columns_), IndexInParts(line.end_y, rows_)};
  return !AnyCellOnLine(
      line, [&](Cell through) { return OnMap(through) && BlocksRadio(through) && !(through == stands_in); });
}

Cell CellOf(const Sensor& sensor, double cell_m, int columns, int rows) {
  const auto nearest = [&](double position_m, int cells) {
    return static_cast<int>(std::clamp(std::ceil(position_m / cell_m - 0.5), 0.0, cells - 1.0));
  };
  return {nearest(sensor.x_m, columns), nearest(sensor.y_m, rows)};
}

}  // namespace fresco
