#include "tests/training/acting_samples.h"

#include <algorithm>
#include <bit>

#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

bool SameFloats(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
    return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
  });
}

}  // namespace

Experiment SmallField(const Settings& settings) {
  return Experiment::Parse(R"(
      scenario {
        grid { columns: 5 rows: 5 } slots: 14
        start { column: 0 row: 0 } stop { column: 4 row: 4 }
        sensor { x_m: 0 y_m: 100 } sensor { x_m: 75 y_m: 25 weight: 2 } sensor { x_m: 10 y_m: 5 }
        coverage_radius_m: 40 initial_energy_j: 1700
      }
      agent { hidden_layers: [48, 32] discount: 0.9 })",
                           "the small field", settings);
}

Settings WithMasks() {
  return {{"agent.safe_action_mask", "true"}, {"agent.coverage_mask", "true"}};
}

SharedParameters SampleNetwork(const Experiment& experiment, uint32_t number) {
  RandomStream stream(2026, RandomPurpose::kTest, 1, number);
  const auto count = static_cast<size_t>(experiment.network()->parameter_count());
  const std::vector<float> values = RandomFloats(stream, count, 0.3);
  return std::make_shared<const Vector>(Eigen::Map<const Vector>(values.data(), static_cast<int64_t>(count)));
}

Order TrainOrder(int64_t index, double epsilon) {
  Order order;
  order.index = index;
  order.epsilon = epsilon;
  order.seed = 1000 + static_cast<uint64_t>(index);
  return order;
}

FlightPlan PlanOf(const Experiment& experiment, int64_t index, double epsilon, uint32_t current,
                  uint32_t target) {
  return {TrainOrder(index, epsilon), SampleNetwork(experiment, current), SampleNetwork(experiment, target)};
}

OrderResult FlyAlone(const Experiment& experiment, const FlightPlan& plan) {
  return FlyTogether(experiment, 1, {plan}, 1).at(plan.order.index);
}

std::map<int64_t, OrderResult> FlyTogether(const Experiment& experiment, int capacity,
                                           const std::vector<FlightPlan>& plans, int per_slot) {
  Flyer flyer(experiment, capacity);
  std::map<int64_t, OrderResult> flown;
  auto next = plans.begin();
  while (next != plans.end() || !flyer.Idle()) {
    for (int i = 0; i < per_slot && next != plans.end() && flyer.HasRoom(); ++i, ++next) {
      flyer.Start(next->order, next->current, next->target);
    }
    flyer.Step([&](const Order& order, const OrderResult& result) { flown.emplace(order.index, result); });
  }
  return flown;
}

bool SameBits(const OrderResult& a, const OrderResult& b) {
  return a.order_index == b.order_index && a.seed == b.seed && a.first_transition == b.first_transition &&
         a.first_field == b.first_field && SameFloats(a.td_errors, b.td_errors) &&
         SameBits(a.episode, b.episode);
}

}  // namespace fresco
