#include "paper/flight_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"

namespace fresco {
namespace {

constexpr int kMapWidthPx = 800;
constexpr int kColourBarPx = 116;

/// A position on the map, in cells.
struct Point {
  double column = 0;
  double row = 0;
};

/// The shift of the path in a slot, in cells, the same for columns and rows. It grows from -0.3 in slot 1 to
/// 0.3 in slot T.
double Shift(const UavWorld& world, int slot) {
  constexpr double kLargestShift = 0.3;
  const double last = std::max(world.scenario().slots - 1, 1);
  return kLargestShift * (2 * (slot - 1) / last - 1);
}

Point Shifted(const UavWorld& world, Cell cell, int slot) {
  const double shift = Shift(world, slot);
  return {cell.column + shift, cell.row + shift};
}

Point SensorPoint(const UavWorld& world, int sensor) {
  const Sensor& position = world.scenario().sensors[static_cast<size_t>(sensor)];
  return {position.x_m / world.scenario().cell_m, position.y_m / world.scenario().cell_m};
}

struct SensorColours {
  const char* disc;
  const char* number;  ///< colour of the number on the disc
};

/// The first colours are ones that the path does not have. If there are more than eight sensors, colours
/// repeat, and only the numbers differ.
SensorColours ColoursOf(int sensor) {
  constexpr const char* kWhite = "#FFFFFF";
  constexpr std::array<SensorColours, 8> kColours = {{{colour::kVermillion, kWhite},
                                                      {colour::kBlue, kWhite},
                                                      {colour::kOrange, colour::kBlack},
                                                      {colour::kPurple, colour::kBlack},
                                                      {colour::kSkyBlue, colour::kBlack},
                                                      {colour::kBlack, kWhite},
                                                      {colour::kGreen, kWhite},
                                                      {colour::kGrey, kWhite}}};
  return kColours[static_cast<size_t>(sensor) % kColours.size()];
}

/// Returns the colour "#RRGGBB" as a number that gnuplot can read from data.
std::string ColourNumber(const char* colour) {
  return fmt::format("0x{}", colour + 1);
}

/// What the cells of a map look like.
struct CellLook {
  CellKind kind;
  const char* name;
  const char* colour;
};

constexpr std::array<CellLook, 4> kCellLooks = {
    {{CellKind::kNoFlying, "no flying", "#F2C4BD"},
     {CellKind::kBlocksRadio, "blocks radio", "#C4E3C0"},
     {CellKind::kBlocksBoth, "both", "#DFCB73"},
     {CellKind::kStartAndLanding, "start and landing", "#C5D9F3"}}};

bool HasKind(const UavWorld& world, CellKind kind) {
  bool found = false;
  for (int cell = 0; world.map() != nullptr && cell < world.map()->columns() * world.map()->rows(); ++cell) {
    found =
        found || world.map()->KindOf({cell % world.map()->columns(), cell / world.map()->columns()}) == kind;
  }
  return found;
}

/// The data of the map's cells that are not just free, a line each: column, row, colour. Empty if there are
/// none.
std::string CellData(const UavWorld& world) {
  std::string lines;
  for (int row = 0; world.map() != nullptr && row < world.map()->rows(); ++row) {
    for (int column = 0; column < world.map()->columns(); ++column) {
      for (const CellLook& look : kCellLooks) {
        if (world.map()->KindOf({column, row}) == look.kind) {
          lines += fmt::format("{} {} {}\n", column, row, ColourNumber(look.colour));
        }
      }
    }
  }
  return lines.empty() ? "" : "$cells << END\n" + lines + "END\n";
}

/// The data of the path, a line for each slot: column, row, slot.
std::string PathData(const UavWorld& world, const Episode& flight) {
  std::string script = "$path << END\n";
  for (const UavState& state : StatesIn(flight)) {
    const Point point = Shifted(world, state.cell, state.slot);
    script += fmt::format("{} {} {}\n", point.column, point.row, state.slot);
  }
  return script + "END\n";
}

/// The data of the collections, a line each: column, row, columns and rows from there to the sensor, its
/// colour.
std::string CollectionData(const UavWorld& world, const Episode& flight) {
  std::string script = "$collections << END\n";
  for (size_t slot = 0; slot <= flight.actions.size(); ++slot) {
    const UavState state = StateIn(flight, slot);
    const int sensor = ActionIn(world, flight, slot).schedule - 1;
    if (sensor >= 0 && world.Covers(state.cell, sensor)) {
      const Point from = Shifted(world, state.cell, state.slot);
      const Point to = SensorPoint(world, sensor);
      script += fmt::format("{} {} {} {} {}\n", from.column, from.row, to.column - from.column,
                            to.row - from.row, ColourNumber(ColoursOf(sensor).disc));
    }
  }
  return script + "END\n";
}

/// The data of the sensors, a line each: column, row, radius, number, colour of the disc, colour of the
/// number.
std::string SensorData(const UavWorld& world) {
  const double radius = world.scenario().coverage_radius_m / world.scenario().cell_m;
  std::string script = "$sensors << END\n";
  for (int sensor = 0; sensor < world.sensors(); ++sensor) {
    const Point point = SensorPoint(world, sensor);
    const SensorColours colours = ColoursOf(sensor);
    script += fmt::format("{} {} {} {} {} {}\n", point.column, point.row, radius, sensor + 1,
                          ColourNumber(colours.disc), ColourNumber(colours.number));
  }
  return script + "END\n";
}

/// The data of start and stop, shifted as the ends of a path through all slots.
std::string EndData(const UavWorld& world) {
  const Scenario& scenario = world.scenario();
  const Point start = Shifted(world, scenario.start, 1);
  const Point stop = Shifted(world, scenario.stop, scenario.slots);
  return fmt::format("$start << END\n{} {}\nEND\n$stop << END\n{} {}\nEND\n", start.column, start.row,
                     stop.column, stop.row);
}

constexpr const char* kBlackLine = "linecolor rgb '#000000'";
constexpr const char* kStartPoint = "pointtype 9 pointsize 1.2";
constexpr const char* kStopPoint = "pointtype 5 pointsize 0.9";

/// Draws from the lowest layer to the highest. 0x60000000 makes a colour a third transparent.
std::string PlotCommand(bool cells, bool collections) {
  const std::string lines =
      "  $collections using 1:2:3:4:($5+0x60000000) with vectors nohead linewidth 0.8 linecolor rgb "
      "variable, \\\n";
  const std::string dots =
      "  $collections using 1:2 with points pointtype 7 pointsize 0.55 linecolor rgb '#FFFFFF', \\\n"
      "  $collections using 1:2:5 with points pointtype 7 pointsize 0.4 linecolor rgb variable, \\\n";
  const std::string ground =
      "$cells using 1:2:(0.5):(0.5):3 with boxxyerror linecolor rgb variable fillstyle solid 1 noborder, "
      "\\\n  ";
  return fmt::format(
      "plot {}$sensors using 1:2:3:5 with circles linecolor rgb variable fillstyle transparent solid 0.08 "
      "noborder, \\\n"
      "  $sensors using 1:2:3:5 with circles linecolor rgb variable linewidth 1 fillstyle empty border, "
      "\\\n{}"
      "  $path using 1:2 with lines linewidth 5 linecolor rgb '#FFFFFF', \\\n"
      "  $path using 1:2:3 with lines linewidth 3 linecolor palette, \\\n{}"
      "  $start with points {} {}, \\\n  $stop with points {} {}, \\\n"
      "  $sensors using 1:2:5 with points pointtype 7 pointsize 1.6 linecolor rgb variable, \\\n"
      "  $sensors using 1:2:4:6 with labels textcolor rgb variable\n",
      cells ? ground : "", collections ? lines : "", collections ? dots : "", kBlackLine, kStartPoint,
      kBlackLine, kStopPoint);
}

/// The number of cells between two tics, so that there are at most eleven tics.
int TicStep(int cells) {
  int step = 1;
  for (const int larger : {2, 5, 10, 20, 50, 100, 200, 500, 1000}) {
    step = (cells - 1) / step > 10 ? larger : step;
  }
  return step;
}

/// Draws thin lines between the cells. They are the grid of the second axes, which have no other use.
std::string CellScript(int columns, int rows) {
  constexpr int kMostCells = 60;  // a larger grid has no lines, since they would cover everything
  if (std::max(columns, rows) > kMostCells) {
    return "";
  }
  return fmt::format(
      "set x2range [-0.5:{}]\nset y2range [-0.5:{}]\n"
      "set x2tics -0.5,1 format '' scale 0\nset y2tics -0.5,1 format '' scale 0\n"
      "set grid noxtics noytics x2tics y2tics back linetype 1 linewidth 0.6 linecolor rgb '{}'\n",
      columns - 0.5, rows - 0.5, colour::kGrid);
}

std::string AxesScript(const UavWorld& world) {
  const int columns = world.scenario().columns;
  const int rows = world.scenario().rows;
  return fmt::format("set border 15 linewidth 1 linecolor rgb '{}'\n", colour::kText) +
         fmt::format("set size ratio -1\nset xrange [-0.5:{}]\nset yrange [-0.5:{}]\n", columns - 0.5,
                     rows - 0.5) +
         fmt::format("set xtics 0,{}\nset ytics 0,{}\n", TicStep(columns), TicStep(rows)) +
         CellScript(columns, rows) +
         // The colours of Viridis without the yellow end, which is hard to see on white.
         "set palette defined (0 '#440154', 1 '#414487', 2 '#2A788E', 3 '#22A884', 4 '#7AD151', 5 "
         "'#BBDF27')\n" +
         fmt::format("set cbrange [1:{}]\n", std::max(world.scenario().slots, 2));
}

Legend MapLegend(const UavWorld& world) {
  std::vector<LegendEntry> entries = {
      {"start", kBlackLine, "", kStartPoint},
      {"stop", kBlackLine, "", kStopPoint},
      {"path", "linecolor rgb '#2A788E'", "linewidth 3", ""},
      {"collection, with a line to its sensor", kBlackLine, "linewidth 0.8", "pointtype 7 pointsize 0.4"}};
  for (const CellLook& look : kCellLooks) {
    if (HasKind(world, look.kind)) {
      entries.push_back(
          {look.name, fmt::format("linecolor rgb '{}'", look.colour), "", "pointtype 5 pointsize 1.4"});
    }
  }
  return Legend(std::move(entries), kMapWidthPx);
}

}  // namespace

Picture DrawFlightMap(const std::string& title, const UavWorld& world, const Episode& flight) {
  const Legend legend = MapLegend(world);
  const Frame frame{
      .title = title, .x_label = "column", .y_label = "row", .right_label = "slot", .right_px = kColourBarPx};
  const int map_width_px = kMapWidthPx - frame.left_px - frame.right_px;
  const int map_height_px =
      std::clamp(map_width_px * world.scenario().rows / world.scenario().columns, 200, 1000);
  Picture picture{kMapWidthPx, frame.top_px + map_height_px + frame.bottom_px + legend.height_px(), ""};
  const std::string cells = CellData(world);
  const std::string collections = CollectionData(world, flight);
  picture.script =
      FrameScript(frame, picture, legend) + AxesScript(world) + cells + PathData(world, flight) +
      collections + SensorData(world) + EndData(world) +
      PlotCommand(!cells.empty(), collections.find(' ', collections.find('\n')) != std::string::npos);
  return picture;
}

}  // namespace fresco
