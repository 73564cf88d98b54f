// A small world of its own, for tests of what holds in any world: a walk along a line.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "core/error.h"
#include "worlds/episode.h"

namespace fresco {

/// The seed says where the walk begins. Action 0 stays, and each other one steps so far to the right. The
/// reward is the new place. After five steps the walk is cut off, but whoever steps beyond place 20 has
/// fallen off the line. Fields that a description adds to the two of a state have values of their own.
class WalkWorld : public World {
 public:
  static WorldDescription Description() {
    WorldDescription description;
    description.name = "walk";
    description.state = {{"place", ""}, {"steps", ""}};
    description.actions = {"stay", "1", "2", "3", "4", "5", "6", "7", "8"};
    description.observation_size = 1;
    description.longest_episode = 5;
    description.figures = {{"last_place", ""}};
    description.success = "stayed_on_the_line";
    return description;
  }

  /// The same with states of so many fields.
  static WorldDescription WideDescription(int fields) {
    WorldDescription description = Description();
    while (static_cast<int>(description.state.size()) < fields) {
      description.state.push_back({"field_" + std::to_string(description.state.size()), ""});
    }
    return description;
  }

  explicit WalkWorld(WorldDescription description = Description()) : World(std::move(description)) {}

  std::unique_ptr<Environment> NewEnvironment() const override;
  void Observe(std::span<const float> state, std::span<float> observation) const override {
    observation[0] = state[0];
  }
  void Judge(const Episode& episode, std::span<double> figures) const override {
    figures[0] = episode.state(episode.actions.size())[0];
  }
  bool Succeeded(const Episode& episode) const override { return episode.ending == Ending::kTruncated; }
};

class WalkEnvironment : public Environment {
 public:
  explicit WalkEnvironment(const WalkWorld& world) : world_(&world) {}

  void Reset(uint64_t seed) override {
    place_ = static_cast<int>(seed % 10);
    steps_ = 0;
    ending_ = Ending::kNone;
  }
  StepResult Step(int action) override {
    FRESCO_CHECK(ending_ == Ending::kNone);
    place_ += action;
    ++steps_;
    if (place_ > 20) {
      ending_ = Ending::kTerminal;
    } else if (steps_ == world_->longest_episode()) {
      ending_ = Ending::kTruncated;
    }
    return {static_cast<double>(place_), ending_};
  }
  void WriteState(std::span<float> state) const override {
    state[0] = static_cast<float>(place_);
    state[1] = static_cast<float>(steps_);
    for (size_t field = 2; field < state.size(); ++field) {
      state[field] = static_cast<float>(place_) + 1 / static_cast<float>(field);
    }
  }

 private:
  const WalkWorld* world_;
  int place_ = 0;
  int steps_ = 0;
  Ending ending_ = Ending::kNone;
};

inline std::unique_ptr<Environment> WalkWorld::NewEnvironment() const {
  return std::make_unique<WalkEnvironment>(*this);
}

}  // namespace fresco
