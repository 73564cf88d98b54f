// Steps a second of environments alone: each takes an action that was drawn beforehand, and writes its state.
// Some take turns, as those of an actor do. Masks are not part of it; the row actor_roof has them.
//
// The reference is the same loop in a world that does nothing, with states and episodes of the same sizes. So
// the ratio is the share of a step's time that is not the world's.
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

/// Environments that take turns, each with an episode of random allowed actions.
class PreparedEpisodes {
 public:
  explicit PreparedEpisodes(const World& world) : state_(static_cast<size_t>(world.state_size())) {
    for (uint64_t seed = 1; seed <= kEnvironments; ++seed) {
      EpisodeRecorder recorder(world, seed);
      RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
      while (!recorder.ended()) {
        recorder.Step(RandomAllowedAction(recorder.mask(), stream));
      }
      episodes_.push_back(recorder.Release());
      environments_.push_back(world.NewEnvironment());
    }
  }

  /// Flies every episode once; returns their steps.
  double Fly() {
    for (size_t i = 0; i < kEnvironments; ++i) {
      environments_[i]->Reset(episodes_[i].seed);
    }
    double steps = 0;
    double before = -1;
    for (size_t step = 0; steps != before; ++step) {
      before = steps;
      for (size_t i = 0; i < kEnvironments; ++i) {
        if (step < episodes_[i].actions.size()) {
          environments_[i]->Step(episodes_[i].actions[step]);
          environments_[i]->WriteState(state_);
          ++steps;
        }
      }
    }
    return steps;
  }

  int MeanLength() { return static_cast<int>(Fly() / kEnvironments); }

 private:
  static constexpr size_t kEnvironments = 50;
  std::vector<Episode> episodes_;
  std::vector<std::unique_ptr<Environment>> environments_;
  std::vector<float> state_;
};

Results StepsOf(const std::string& name, const std::string& config, double seconds) {
  const Experiment experiment = Experiment::Load(ExperimentPath(config));
  PreparedEpisodes episodes(experiment.world());
  const IdleWorld idle(experiment.world(), episodes.MeanLength());
  PreparedEpisodes idle_episodes(idle);
  const Speeds speeds =
      Alternate([&] { return episodes.Fly(); }, {[&] { return idle_episodes.Fly(); }}, seconds);
  return {{MoreIsBetter(name, speeds.value, "steps/s", "the same loop in a world that does nothing",
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
