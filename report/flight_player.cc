#include "report/flight_player.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "report/report_html.h"
#include "report/result_display.h"
#include "worlds/uav/flight.h"
#include "worlds/uav/uav_fields.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::string_view kPlayerHtml =
#include "report/flight_player.html.inc"
    ;
// Each file uses functions of the files before it.
constexpr std::string_view kPlayerScript =
#include "report/aoi_bars.js.inc"
#include "report/flight_data.js.inc"
#include "report/flight_map.js.inc"
#include "report/flight_player.js.inc"
    ;

OrderedJson CellJson(Cell cell) {
  return {{"column", cell.column}, {"row", cell.row}};
}

OrderedJson WorldJson(const UavWorld& world) {
  const Scenario& scenario = world.scenario();
  OrderedJson sensors = OrderedJson::array();
  for (const Sensor& sensor : scenario.sensors) {
    sensors.push_back({{"x_m", sensor.x_m}, {"y_m", sensor.y_m}, {"weight", sensor.weight}});
  }
  OrderedJson json = {{"columns", scenario.columns},
                      {"rows", scenario.rows},
                      {"cell_m", scenario.cell_m},
                      {"slots", scenario.slots},
                      {"start", CellJson(scenario.start)},
                      {"stop", CellJson(scenario.stop)},
                      {"coverage_radius_m", scenario.coverage_radius_m},
                      {"sensors", std::move(sensors)}};
  if (world.map() != nullptr) {
    json["map"] = world.map()->Text();  // the northern row first
  }
  return json;
}

/// Returns what `fresco evaluate --format json` prints, and adds for each slot whether the scheduled sensor
/// is collected, that is, covered.
OrderedJson FlightDataJson(const UavWorld& world, const Episode& flight) {
  OrderedJson json = OrderedJson::parse(EpisodeJson(world.Tell(flight), ""));
  for (size_t slot = 0; slot <= flight.actions.size(); ++slot) {
    const Cell cell = CellIn(flight.state(slot));
    const int scheduled = ActionIn(world, flight, slot).schedule;
    json["flight"][slot]["collected"] = scheduled > 0 && world.Covers(cell, scheduled - 1);
  }
  return json;
}

std::string FlightsHtml(const World& any_world, const std::vector<ReportEpisode>& flights) {
  const std::shared_ptr<const UavWorld> field = OverItsField(any_world, flights.front().episode).field;
  OrderedJson array = OrderedJson::array();
  for (const ReportEpisode& flight : flights) {
    array.push_back(FlightDataJson(*field, OverItsField(any_world, flight.episode).flight));
    array.back()["policy"] = flight.name;
  }
  const OrderedJson data = {{"world", WorldJson(*field)}, {"flights", std::move(array)}};
  // Bytes of a name that are not UTF-8 become replacement characters.
  const std::string text = data.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  return FilledTemplate(kPlayerHtml, {{"data", EscapedJson(text)}});
}

}  // namespace

const Drawing kFlightPlayer = {
    HasFlights, "flights", "Flights", FlightsHtml, kPlayerScript, "AoI is age of information, in slots.",
};

}  // namespace fresco
