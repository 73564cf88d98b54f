#include "actors/actor_memory.h"

#include <algorithm>

#include "actors/network_store.h"
#include "msgs/versions_in_flight.h"
#include "training/flyer.h"

namespace fresco {

MemoryNeed ActorMemory(const Experiment& experiment, int capacity) {
  const World world(experiment.scenario());
  const int64_t parameters = experiment.network_shape().parameter_count();
  const int64_t orders = MaximumOrdersInFlight(experiment.schedule().window());
  const VersionsInFlight versions = MostVersionsInFlight(experiment);
  const int64_t wanted = std::min(orders, versions.current) + std::min(orders, versions.target);
  const int64_t of_order = static_cast<int64_t>(2 * sizeof(Order)) + LongestResultBytes(world);
  return {"actor",
          1,
          {{"run.environments_per_actor", "its environments",
            Flyer::BytesFor(world, experiment, capacity, std::min<int64_t>(capacity, orders))},
           {"agent.hidden_layers", "the networks that it holds", NetworkStore::BytesFor(parameters, wanted)},
           {"schedule.window", "the episodes of the orders in flight", orders * of_order},
           {"scenario.grid", "the field", world.bytes()},
           {"run.actors", "the program", kProgramBytes}}};
}

}  // namespace fresco
