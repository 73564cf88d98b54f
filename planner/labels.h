// The labels of one slot, stored by field. A label is a partial flight: a way to be over a cell at the
// beginning of the slot, with the AoI and the cost that it has led to. A plain value. Not thread-safe.
// Part of the exact planner.
#pragma once

#include <cstdint>
#include <vector>

#include "worlds/uav/uav_world.h"

namespace fresco {

/// The label of the slot before that a label extends, and the action that led from there.
struct Trail {
  uint32_t parent = 0;
  int16_t schedule = 0;
  Move move = Move::kHover;
};

struct Labels {
  /// The labels over one cell are neighbours: begin .. end - 1.
  struct Range {
    int32_t cell;
    size_t begin;
    size_t end;
  };
  std::vector<Range> ranges;
  std::vector<int64_t> cost;   // cost of the slots before this one
  std::vector<int64_t> bound;  // lower bound of the total cost of any flight that continues the label
  std::vector<int64_t> least;  // Dominance::LeastCost
  std::vector<int32_t> dear;   // dear slots so far (PlannerProblem::IsDear)
  std::vector<int16_t> aoi;    // [labels x sensors]
  std::vector<Trail> trails;

  size_t size() const { return cost.size(); }
  void Clear() {
    ranges.clear();
    cost.clear();
    bound.clear();
    least.clear();
    dear.clear();
    aoi.clear();
    trails.clear();
  }
  void Append(const Labels& from, size_t index, size_t sensors) {
    cost.push_back(from.cost[index]);
    bound.push_back(from.bound[index]);
    least.push_back(from.least[index]);
    dear.push_back(from.dear[index]);
    const int16_t* values = from.aoi.data() + index * sensors;
    aoi.insert(aoi.end(), values, values + sensors);
    trails.push_back(from.trails[index]);
  }
  static int64_t Bytes(int sensors) {
    return 3 * sizeof(int64_t) + sizeof(int32_t) + sizeof(Trail) +
           sensors * static_cast<int64_t>(sizeof(int16_t));
  }
};

}  // namespace fresco
