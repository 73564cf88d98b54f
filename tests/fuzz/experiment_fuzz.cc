// Experiment::Parse of text, as an actor does with what FRESCO_RUN brings. What is accepted can be flown,
// fits the memory of an actor, and says the same when it is read again.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "msgs/experiment.h"
#include "tests/fuzz/fuzz_input.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

bool AreFinite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

/// Whatever the world, what goes over the wire of an episode in it is finite, and what the network sees of
/// it.
void CheckEpisode(const World& world) {
  constexpr int kLongest = 30;
  EpisodeRecorder recorder(world, 1);
  std::vector<float> observation(static_cast<size_t>(world.observation_size()));
  for (int step = 0; step < kLongest && !recorder.ended(); ++step) {
    recorder.Step(step * 7 % world.actions());
    FRESCO_CHECK(std::isfinite(recorder.episode().rewards.back()) && AreFinite(recorder.state()));
    FRESCO_CHECK(std::count(recorder.mask().begin(), recorder.mask().end(), 1) >= 1);
    world.Observe(recorder.state(), observation);
    FRESCO_CHECK(AreFinite(observation));
  }
}

void CheckAccepted(const Experiment& experiment) {
  const World& world = experiment.world();
  CheckEpisode(world);
  const Network& network = *experiment.network();
  FRESCO_CHECK(network.outputs() == world.actions());
  FRESCO_CHECK(network.parameter_count() <= kMaximumParameters);
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
