// Experiment::Parse of text, as an actor does with what FRESCO_RUN brings. What is accepted can be flown,
// fits the memory of an actor, and says the same when it is read again.
#include <cmath>

#include "core/error.h"
#include "msgs/experiment.h"
#include "tests/fuzz/fuzz_input.h"
#include "worlds/uav/environment.h"

namespace fresco {
namespace {

/// Whatever the world, what goes over the wire of a flight in it is finite.
void CheckFlight(const World& world) {
  constexpr int kLongest = 30;
  Environment environment(world);
  for (int slot = 0; slot < kLongest && environment.outcome() == Outcome::kFlying; ++slot) {
    const StepResult result = environment.Step(world.ActionAt(slot * 7 % world.actions()));
    FRESCO_CHECK(std::isfinite(static_cast<float>(result.reward)));
    FRESCO_CHECK(std::isfinite(environment.state().energy_margin_j));
  }
}

void CheckAccepted(const Experiment& experiment) {
  const World world(experiment.scenario());
  CheckFlight(world);
  const MlpShape shape = experiment.network_shape();
  FRESCO_CHECK(shape.outputs() == world.actions());
  FRESCO_CHECK(shape.parameter_count() <= kMaximumParameters);
  const Experiment again = Experiment::Parse(experiment.Text(), "its own text");
  FRESCO_CHECK(again.Text() == experiment.Text());
  FRESCO_CHECK(again.hash() == experiment.hash());
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  Accepts([&] { CheckAccepted(Experiment::Parse(std::string(TextOf(data, size)), "an input")); });
  return 0;
}
