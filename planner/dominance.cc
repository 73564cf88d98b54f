#include "planner/dominance.h"

#include <algorithm>
#include <array>

namespace fresco {
namespace {

constexpr size_t kLabelsAtOnce = 16;
constexpr double kNever = 1e300;

}  // namespace

// A breadth-first search from all cells that cover the sensor. Only cells that can be
// flown over cover it, and flights may cross all of these, so the distances are exact.
CoverageDistances::CoverageDistances(const PlannerProblem& problem, WorkMeter& meter)
    : cells_(static_cast<size_t>(problem.cells())) {
  constexpr int64_t kUnitsPerCell = 64;
  distances_.reserve(static_cast<size_t>(problem.size()) * cells_);
  std::vector<int> front;
  for (int sensor = 0; sensor < problem.size(); ++sensor) {
    if (!meter.Count(problem.cells() * kUnitsPerCell)) {
      return;
    }
    distances_.resize(distances_.size() + cells_, static_cast<int16_t>(problem.slots()));
    int16_t* distance = distances_.data() + static_cast<size_t>(sensor) * cells_;
    front.clear();
    for (int cell = 0; cell < problem.cells(); ++cell) {
      if (problem.Covers(cell, sensor)) {
        distance[cell] = 0;
        front.push_back(cell);
      }
    }
    for (size_t i = 0; i < front.size(); ++i) {
      const int cell = front[i];
      for (const Move move : kAllMoves) {
        const int after = problem.After(cell, move);
        if (after >= 0 && distance[after] > distance[cell] + 1) {
          distance[after] = static_cast<int16_t>(distance[cell] + 1);
          front.push_back(after);
        }
      }
    }
  }
}

Dominance::Dominance(const PlannerProblem& problem, const CoverageDistances& distances, int slot, int cell)
    : problem_(&problem) {
  const int slots_left = problem.slots() - slot + 1;
  for (int sensor = 0; sensor < problem.size(); ++sensor) {
    const int until_served = std::min(distances.At(sensor, cell) + 1, slots_left);
    shortest_unserved_.push_back(problem.is_capped() ? 0 : until_served);
  }
}

int64_t Dominance::LeastCost(int64_t cost, const int16_t* aoi) const {
  for (size_t n = 0; n < shortest_unserved_.size(); ++n) {
    cost += problem_->weights()[n] * shortest_unserved_[n] * aoi[n];
  }
  return cost;
}

void Undominated::Clear() {
  size_ = 0;
  least_.clear();
  dear_.clear();
  for (std::vector<double>& values : aoi_) {
    values.clear();
  }
}

void Undominated::Add(int64_t least, int dear, const int16_t* aoi) {
  if (size_ % kLabelsAtOnce == 0) {
    least_.resize(size_ + kLabelsAtOnce, kNever);
    dear_.resize(size_ + kLabelsAtOnce, 0);
    for (std::vector<double>& values : aoi_) {
      values.resize(size_ + kLabelsAtOnce, 0);
    }
  }
  least_[size_] = static_cast<double>(least);
  dear_[size_] = dear;
  for (size_t n = 0; n < aoi_.size(); ++n) {
    aoi_[n][size_] = aoi[n];
  }
  ++size_;
}

bool Undominated::Beat(int64_t least, int dear, const int16_t* aoi, const double* gaps) const {
  for (size_t begin = 0; begin < size_; begin += kLabelsAtOnce) {
    std::array<double, kLabelsAtOnce> excess;
    for (size_t i = 0; i < kLabelsAtOnce; ++i) {
      excess[i] = least_[begin + i] - static_cast<double>(least);
    }
    for (size_t n = 0; n < aoi_.size(); ++n) {
      const double* older = aoi_[n].data() + begin;
      for (size_t i = 0; i < kLabelsAtOnce; ++i) {
        excess[i] += gaps[n] * std::max(0.0, older[i] - aoi[n]);
      }
    }
    for (size_t i = 0; energy_binds_ && i < kLabelsAtOnce; ++i) {
      excess[i] += dear_[begin + i] > dear ? kNever : 0;
    }
    if (*std::min_element(excess.begin(), excess.end()) <= 0) {
      return true;
    }
  }
  return false;
}

}  // namespace fresco
