#include "report/flight_json.h"

#include <nlohmann/json.hpp>

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

}  // namespace

std::string FlightJson(const World& world, const Flight& flight, const std::string& policy,
                       const std::optional<Plan>& plan) {
  const AoiFigures figures = Figures(world, flight);
  OrderedJson json = {{"policy", policy},
                      {"arrived", flight.arrived()},
                      {"outcome", OutcomeName(flight.outcome)},
                      {"slots", flight.slots.size()},
                      {"total_aoi", figures.total_aoi},
                      {"average_aoi", figures.average_aoi},
                      {"sum_aoi", figures.sum_aoi},
                      {"residual_energy_j", flight.residual_energy_j}};
  if (plan) {
    json["optimal"] = plan->optimal;
    json["lower_bound_total_aoi"] = plan->lower_bound_total_aoi;
    json["lower_bound_average_aoi"] = plan->lower_bound_average_aoi;
  }
  OrderedJson& slots = json["flight"] = OrderedJson::array();
  for (const FlightSlot& slot : flight.slots) {
    slots.push_back({{"slot", slot.state.slot},
                     {"column", slot.state.cell.column},
                     {"row", slot.state.cell.row},
                     {"move", MoveName(slot.action.move)},
                     {"scheduled", slot.action.schedule},
                     {"aoi", slot.state.aoi}});
  }
  return json.dump(2);
}

}  // namespace fresco
