// Steps a second of one environment, by random allowed actions, recorded as an actor records an episode.
//
// The reference is the same loop in a world that does nothing: states, masks and episodes of the same sizes,
// and the same random choices. So the ratio is the share of a step's time that is not the world's.
#include <algorithm>

#include "msgs/experiment.h"
#include "msgs/ready_experiments.h"
#include "tests/bench/alternate.h"
#include "tests/bench/subjects.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

/// Ends every episode after the same number of steps, with a state of zeros and every action allowed.
class IdleEnvironment : public Environment {
 public:
  explicit IdleEnvironment(int steps) : steps_(steps) {}
  void Reset(uint64_t) override { taken_ = 0; }
  StepResult Step(int) override { return {0, ++taken_ == steps_ ? Ending::kTerminal : Ending::kNone}; }
  void WriteState(std::span<float> state) const override { std::fill(state.begin(), state.end(), 0.0F); }
  void WriteMask(std::span<uint8_t> mask) const override { std::fill(mask.begin(), mask.end(), 1); }

 private:
  int steps_;
  int taken_ = 0;
};

/// A world that does nothing, with states and actions of the same number as another one's.
class IdleWorld : public World {
 public:
  IdleWorld(const World& like, int steps) : World(like.description()), steps_(steps) {}
  std::unique_ptr<Environment> NewEnvironment() const override {
    return std::make_unique<IdleEnvironment>(steps_);
  }
  void Observe(std::span<const float>, std::span<float>) const override {}
  bool Succeeded(const Episode&) const override { return true; }

 private:
  int steps_;
};

/// Episodes one after the other.
class RandomEpisodes {
 public:
  explicit RandomEpisodes(const World& world) : recorder_(world, 1) {}

  /// Flies some episodes; returns their transitions.
  double FlySome() {
    double transitions = 0;
    for (int i = 0; i < kSome; ++i) {
      recorder_.Begin(++seed_);
      RandomStream stream(seed_, RandomPurpose::kTest, 0, 0);
      while (!recorder_.ended()) {
        recorder_.Step(RandomAllowedAction(recorder_.mask(), stream));
      }
      transitions += recorder_.episode().transitions();
    }
    return transitions;
  }

  static constexpr int kSome = 50;

 private:
  EpisodeRecorder recorder_;
  uint64_t seed_ = 0;
};

Results StepsOf(const std::string& name, const std::string& config, double seconds) {
  const Experiment experiment = Experiment::Load(ExperimentPath(config));
  RandomEpisodes episodes(experiment.world());
  const IdleWorld idle(experiment.world(), static_cast<int>(episodes.FlySome() / RandomEpisodes::kSome));
  RandomEpisodes idle_episodes(idle);
  const Speeds speeds =
      Alternate([&] { return episodes.FlySome(); }, {[&] { return idle_episodes.FlySome(); }}, seconds);
  return {{MoreIsBetter(name, speeds.value, "steps/s",
                        "the same loop, random choices included, in a world that does nothing",
                        speeds.references.front())},
          {}};
}

}  // namespace

std::vector<Subject> EnvironmentSubjects() {
  const auto subject = [](const std::string& name, const std::string& config) {
    return Subject{{name}, [=](double seconds) { return StepsOf(name, config, seconds); }};
  };
  return {subject("environment_uav", "quick"), subject("environment_cartpole", "cartpole"),
          subject("environment_acrobot", "acrobot")};
}

}  // namespace fresco
