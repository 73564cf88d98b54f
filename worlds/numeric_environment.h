// What environments of physical systems share: a state of a few numbers that starts at random around zero,
// and a limit of steps. Only one thread at a time may use an object. Does not allocate.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/error.h"
#include "core/random.h"
#include "worlds/world.h"

namespace fresco {

template <size_t kFields>
class NumericEnvironment : public Environment {
 public:
  using State = std::array<double, kFields>;

  /// Every field of the first state is uniform in (-largest_at_start, largest_at_start). After
  /// `maximum_steps` the episode is truncated, unless it ends in a terminal state there.
  NumericEnvironment(double largest_at_start, int maximum_steps)
      : largest_at_start_(largest_at_start), maximum_steps_(maximum_steps) {}

  void Reset(uint64_t seed) final {
    RandomStream stream(seed, RandomPurpose::kEpisodeStart, 0, 0);
    for (double& field : state_) {
      field = largest_at_start_ * (2 * stream.NextUniform() - 1);
    }
    steps_ = 0;
    ending_ = Ending::kNone;
  }

  StepResult Step(int action) final {
    FRESCO_CHECK(ending_ == Ending::kNone);
    const StepResult result = Advance(action, state_);
    ++steps_;
    ending_ = result.ending == Ending::kNone && steps_ == maximum_steps_ ? Ending::kTruncated : result.ending;
    return {result.reward, ending_};
  }

  void WriteState(std::span<float> state) const final {
    FRESCO_CHECK(state.size() == kFields);
    std::transform(state_.begin(), state_.end(), state.begin(),
                   [](double field) { return static_cast<float>(field); });
  }

 private:
  /// Advances the state by one step. Returns the reward, and kTerminal or kNone.
  virtual StepResult Advance(int action, State& state) = 0;

  double largest_at_start_;
  int maximum_steps_;
  State state_{};
  int steps_ = 0;
  Ending ending_ = Ending::kNone;
};

}  // namespace fresco
