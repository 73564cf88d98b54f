#include "exports/policy_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace fresco {

std::vector<Chain> ChainsOf(const Network& network) {
  std::vector<Chain> chains(1);
  int inputs = 0;  // none yet
  int64_t next = 0;
  for (const int size : network.layer_sizes()) {
    if (size == 0) {
      chains.emplace_back();
    } else if (inputs > 0) {
      chains.back().layers.push_back({inputs, size, next});
      next = chains.back().layers.back().end();
    }
    inputs = size;
  }
  FRESCO_CHECK(next == network.parameter_count() && (chains.size() == 1 || chains.size() == 3));
  static constexpr const char* kNames[] = {"encoder", "trunk", "head"};
  for (size_t i = 0; i < chains.size(); ++i) {
    chains[i].name = chains.size() == 1 ? "network" : kNames[i];
  }
  return chains;
}

std::unique_ptr<PolicyFormulas> FormulasOf(const World& world) {
  auto formulas = std::make_unique<PolicyFormulas>();
  const std::optional<StateFormulas> of_state = world.Formulate(formulas->list);
  if (!of_state) {
    throw UsageError(
        "the world of this policy can't state as formulas what the network sees, as fields that are drawn "
        "over a "
        "map can't; give --config of one field over the map, or --format csv");
  }
  formulas->of_state = *of_state;
  formulas->used.resize(formulas->list.formulas().size());
  formulas->used[static_cast<size_t>(of_state->observation.index)] = true;
  if (of_state->mask) {
    formulas->used[static_cast<size_t>(of_state->mask->index)] = true;
  }
  for (size_t i = formulas->used.size(); i-- > 0;) {
    for (const int operand : formulas->list.formulas()[i].operands) {
      formulas->used[static_cast<size_t>(operand)] =
          formulas->used[static_cast<size_t>(operand)] || formulas->used[i];
    }
  }
  return formulas;
}

std::string PolicyTitle(const StoredNetwork& network) {
  return fmt::format("current network version {} ({} updates), world {}", network.version, network.updates,
                     network.experiment.world().description().name);
}

}  // namespace fresco
