// Experiments, networks and orders that the tests of actors/ share.
#pragma once

#include <map>
#include <vector>

#include "training/flyer.h"
#include "worlds/uav/uav_world.h"

namespace fresco {

/// 5 x 5 cells, 14 slots, three sensors, energy for two hovers, a network of 9 chunks; no masks, plain
/// DQN, discount 0.9.
Experiment SmallField(const Settings& settings = {});

/// The settings that switch both masks on.
Settings WithMasks();

/// Weights and biases uniform in [-0.3, 0.3), other ones for every number.
SharedParameters SampleNetwork(const Experiment& experiment, uint32_t number);

/// Versions 0 of both networks, seed 3.
Order TrainOrder(int64_t index, double epsilon);

/// What Flyer::Start takes.
struct FlightPlan {
  Order order;
  SharedParameters current;
  SharedParameters target;
};

/// An order of the sample networks with these numbers.
FlightPlan PlanOf(const Experiment& experiment, int64_t index, double epsilon, uint32_t current = 1,
                  uint32_t target = 0);

/// Flies one order in a flyer of its own.
OrderResult FlyAlone(const Experiment& experiment, const FlightPlan& plan);

/// Flies all plans in one flyer, `per_slot` of them started before every slot while there is room.
/// The results by order.
std::map<int64_t, OrderResult> FlyTogether(const Experiment& experiment, int capacity,
                                           const std::vector<FlightPlan>& plans, int per_slot);

/// Whether everything in two results is equal, floats by their bits.
bool SameBits(const OrderResult& a, const OrderResult& b);

}  // namespace fresco
