#include "report/flight_json.h"

#include <nlohmann/json.hpp>

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

}  // namespace

std::string FlightJson(const World& world, const Episode& flight, const std::string& policy,
                       const std::optional<Plan>& plan) {
  const AoiFigures figures = Figures(world, flight);
  OrderedJson json = {{"policy", policy},
                      {"arrived", flight.arrived()},
                      {"outcome", OutcomeName(flight.outcome)},
                      {"slots", flight.states.size()},
                      {"total_aoi", figures.total_aoi},
                      {"average_aoi", figures.average_aoi},
                      {"sum_aoi", figures.sum_aoi},
                      {"residual_energy_j", ResidualEnergy(world, flight)}};
  if (plan) {
    json["optimal"] = plan->optimal;
    json["lower_bound_total_aoi"] = plan->lower_bound_total_aoi;
    json["lower_bound_average_aoi"] = plan->lower_bound_average_aoi;
  }
  OrderedJson& slots = json["flight"] = OrderedJson::array();
  for (size_t slot = 0; slot < flight.states.size(); ++slot) {
    const State& state = flight.states[slot];
    const Action action = ActionIn(world, flight, slot);
    slots.push_back({{"slot", state.slot},
                     {"column", state.cell.column},
                     {"row", state.cell.row},
                     {"move", MoveName(action.move)},
                     {"scheduled", action.schedule},
                     {"aoi", state.aoi}});
  }
  return json.dump(2);
}

}  // namespace fresco
