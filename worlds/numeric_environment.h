// What environments of physical systems share: a state of a few numbers that starts at random around zero,
// and a limit of steps. Only one thread at a time may use an object. Does not allocate.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/error.h"
#include "core/random.h"
#include "worlds/world.h"

namespace fresco {

/// `kAdvance` advances the fields by a step with an action, and returns the reward, and kTerminal or kNone.
template <size_t kFields, StepResult (*kAdvance)(int action, std::array<double, kFields>& state)>
class NumericEnvironment final : public Environment {
 public:
  /// Every field of the first state is uniform in (-largest_at_start, largest_at_start). After
  /// `maximum_steps` the episode is truncated, unless it ends in a terminal state there.
  NumericEnvironment(double largest_at_start, int maximum_steps)
      : largest_at_start_(largest_at_start), maximum_steps_(maximum_steps) {}

  void Reset(uint64_t seed) override {
    RandomStream stream(seed, RandomPurpose::kEpisodeStart, 0, 0);
    for (double& field : state_) {
      field = largest_at_start_ * (2 * stream.NextUniform() - 1);
    }
    steps_ = 0;
    ending_ = Ending::kNone;
  }

  StepResult Step(int action) override {
    FRESCO_CHECK(ending_ == Ending::kNone);
    const StepResult result = kAdvance(action, state_);
    ++steps_;
    ending_ = result.ending == Ending::kNone && steps_ == maximum_steps_ ? Ending::kTruncated : result.ending;
    return {result.reward, ending_};
  }

  void CopyFrom(const Environment& other) override { *this = static_cast<const NumericEnvironment&>(other); }

  void WriteState(std::span<float> state) const override {
    FRESCO_CHECK(state.size() == kFields);
    for (size_t field = 0; field < kFields; ++field) {
      state[field] = static_cast<float>(state_[field]);
    }
  }

 private:
  double largest_at_start_;
  int maximum_steps_;
  std::array<double, kFields> state_{};
  int steps_ = 0;
  Ending ending_ = Ending::kNone;
};

}  // namespace fresco
