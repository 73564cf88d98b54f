// Writes report pages of real flights, and the flights themselves in plain CSV to compare with:
//   write_report_pages FOLDER CONFIG FIGURE.svg
// run.html: the exact optimum and both baselines of CONFIG. large.html: as many sensors, cells and slots
// as the page is made for. harmful.html: texts that would run as scripts if they were not escaped.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "core/error.h"
#include "msgs/experiment.h"
#include "planner/planner.h"
#include "report/report.h"
#include "tests/worlds/table_one.h"
#include "worlds/uav/aoi_figures.h"
#include "worlds/uav/baselines.h"
#include "worlds/uav/flight.h"

namespace fresco {
namespace {

void WriteText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    throw Failure(fmt::format("{}: can't be written", path.string()));
  }
}

std::string ReadText(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    throw Failure(fmt::format("{}: can't be read", path.string()));
  }
  return text.str();
}

/// Returns a line for each slot: flight, slot, column, row, move, scheduled, collected, then the AoI of every
/// sensor.
std::string Csv(const UavWorld& world, const std::vector<ReportEpisode>& flights) {
  std::string csv;
  for (const ReportEpisode& flight : flights) {
    for (size_t slot = 0; slot <= flight.episode.actions.size(); ++slot) {
      const UavState state = StateIn(flight.episode, slot);
      const Action action = ActionIn(world, flight.episode, slot);
      const bool collected = action.schedule > 0 && world.Covers(state.cell, action.schedule - 1);
      csv +=
          fmt::format("{},{},{},{},{},{},{},{}\n", flight.name, state.slot, state.cell.column, state.cell.row,
                      MoveName(action.move), action.schedule, collected ? 1 : 0, fmt::join(state.aoi, ","));
    }
  }
  return csv;
}

std::vector<std::string> FlightRow(const UavWorld& world, const ReportEpisode& flight) {
  const AoiFigures figures = Figures(world, flight.episode);
  return {flight.name, fmt::format("{:.3f}", figures.average_aoi), fmt::format("{}", figures.total_aoi),
          fmt::format("{:.0f}", ResidualEnergy(world, flight.episode))};
}

void WritePage(const std::filesystem::path& folder, const std::string& name, const UavWorld& world,
               ReportContents contents) {
  contents.world = &world;
  WriteText(folder / (name + ".html"), ReportPage(contents));
  WriteText(folder / (name + ".csv"), Csv(world, contents.episodes));
}

void WriteRun(const std::filesystem::path& folder, const Experiment& experiment, const std::string& svg) {
  const UavWorld& world = RequireUavWorld(experiment.world(), "a report of flights");
  ReportContents contents;
  contents.title = "Three sensors, R = 100 m";
  contents.summary =
      "The exact optimum of the paper's field beside its two comparison algorithms: 70 slots of a second on "
      "a grid of 20 by 20 cells, from the middle of the southern edge to the middle of the northern one.";
  contents.episodes = {{"exact optimum", PlanOptimally(world, 0).flight},
                       {"AoI-based", FlyBaseline(world, BaselineKind::kAoi)},
                       {"distance-based", FlyBaseline(world, BaselineKind::kDistance)}};
  contents.tables = {{"Flights", {"flight", "average AoI", "total AoI", "energy left (J)"}, {}},
                     {"Field",
                      {},
                      {{"sensors", std::to_string(world.sensors())},
                       {"slots", std::to_string(world.scenario().slots)},
                       {"covered within", fmt::format("{} m", world.scenario().coverage_radius_m)}}}};
  for (const ReportEpisode& flight : contents.episodes) {
    contents.tables.front().rows.push_back(FlightRow(world, flight));
  }
  contents.figures = {{"One figure", "The same drawing twice: its ids must not clash.", svg},
                      {"The same figure again", "", svg}};
  contents.configuration = experiment.Text();
  WritePage(folder, "run", world, contents);
}

void WriteLarge(const std::filesystem::path& folder) {
  Scenario scenario = TableOne();
  scenario.columns = scenario.rows = 100;
  scenario.slots = 1000;
  scenario.initial_energy_j = 300000;
  scenario.start = {50, 0};
  scenario.stop = {50, 99};
  scenario.sensors = RandomSensors(scenario.columns, scenario.rows, scenario.cell_m, 250, 7);
  const UavWorld world(scenario);
  ReportContents contents;
  contents.title = "250 sensors, 1000 slots";
  contents.episodes = {{"AoI-based", FlyBaseline(world, BaselineKind::kAoi)},
                       {"distance-based", FlyBaseline(world, BaselineKind::kDistance)}};
  WritePage(folder, "large", world, contents);
}

void WriteHarmful(const std::filesystem::path& folder, const Scenario& scenario) {
  const UavWorld world(scenario);
  const std::string harm = "\"'></title></script><script>window.harmed = true</script><!-- {{script}} &amp;";
  ReportContents contents;
  contents.title = contents.summary = contents.configuration = harm;
  contents.episodes = {{harm, FlyBaseline(world, BaselineKind::kAoi)}};
  contents.tables = {{harm, {harm}, {{harm}}}};
  contents.figures = {
      {harm, harm, "<svg xmlns=\"http://www.w3.org/2000/svg\"><script>top.harmed = true</script></svg>"},
      {"not closed", "", "<svg xmlns=\"http://www.w3.org/2000/svg\"><g></svg>"},
      {"empty", "", ""}};
  WritePage(folder, "harmful", world, contents);
}

}  // namespace
}  // namespace fresco

int main(int count, char** arguments) {
  if (count != 4) {
    std::cerr << "usage: write_report_pages FOLDER CONFIG FIGURE.svg\n";
    return 2;
  }
  try {
    const fresco::Experiment experiment = fresco::Experiment::Load(arguments[2], {});
    fresco::WriteRun(arguments[1], experiment, fresco::ReadText(arguments[3]));
    fresco::WriteLarge(arguments[1]);
    fresco::WriteHarmful(arguments[1],
                         fresco::RequireUavWorld(experiment.world(), "a report of flights").scenario());
    return 0;
  } catch (const fresco::Error& error) {
    std::cerr << error.what() << "\n";
    return error.exit_status();
  }
}
