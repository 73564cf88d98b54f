// A world is what agents act in: it says what a state, an observation and an action are, and makes
// environments. An environment is one episode at a time of it. Everything above this room uses these two
// interfaces only; how to add a world is in CONTRIBUTING.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/random.h"
#include "worlds/episode_account.h"
#include "worlds/formulas.h"

namespace fresco {

struct Episode;

/// The longest name of a quantity, a success or an action.
inline constexpr size_t kMaximumNameBytes = 63;

/// A quantity for people: the name has lower-case letters, digits and underscores, such as "energy_margin_j";
/// the unit is empty if the quantity has none.
struct Quantity {
  std::string name;
  std::string unit;
};

/// Returns a name for people: "average AoI" for "average_aoi".
std::string Title(const std::string& name);

/// A known policy, e.g. {"aoi", "AoI-based"}: its name in commands and files, and for people.
struct ReferencePolicy {
  std::string name;
  std::string title;
};

/// An observation that holds a set of alike items, such as sensors: `own_inputs` numbers of the agent itself,
/// then `item_inputs` numbers of each item, item after item. The first number of an item is 1 if it is
/// present and 0 if it is absent; an absent item influences nothing, and the mask forbids its actions. Action
/// group * (items + 1) + k concerns no item if k is 0, otherwise item k - 1.
struct ObservationSets {
  int own_inputs = 0;   ///< >= 1
  int items = 0;        ///< the most items, >= 1
  int item_inputs = 0;  ///< >= 1
  int groups = 0;       ///< of actions, e.g. moves, >= 1
};

/// Which of two values of a state's field is at least as good.
enum class Preference : uint8_t { kOnlyEqual, kLess, kMore };

/// What a world states about itself.
struct WorldDescription {
  std::string name;                  ///< of the kind of world, e.g. "cartpole"
  std::vector<Quantity> state;       ///< the fields of a state, 1 to kMaximumStateSize
  std::vector<std::string> actions;  ///< a name for each action, e.g. "push left"; 1 to kMaximumActions
  int observation_size = 0;          ///< inputs of the network, >= 1
  int longest_episode = 0;           ///< transitions, 1 to kMaximumEpisode
  double discount = 1;               ///< gamma, unless the configuration sets agent.discount; 0 to 1
  /// Whether an episode is a pure function of the configuration, its seed and its actions, and cheap to
  /// repeat. If so, the learner flies every episode again and refuses a result that differs by a bit.
  bool repeatable = true;
  /// Whether the seed decides anything. If not, one evaluation is exact.
  bool random = true;
  /// Whether the same action in the same state may have another result. If not, what an episode earned from a
  /// state on can be earned again.
  bool chance = true;
  /// Whether its environments have CopyFrom, so that a search can try several actions from one state.
  bool copies = false;
  /// For each field of a state, which values are at least as good. All fields together: whatever an episode
  /// that succeeds does and earns from some state on, can be done from each state that is as good in every
  /// field, and earns at least as much there. So a search need not follow the worse one. Empty: all fields
  /// are kOnlyEqual.
  std::vector<Preference> preferences;
  std::vector<Quantity> figures;  ///< what an episode is judged by; the first one is its score
  bool less_is_better = false;    ///< of two scores
  std::string success;            ///< what an episode that succeeds did, e.g. "arrived"
  /// Set if the observation is one for agent.set_network.
  std::optional<ObservationSets> sets;
};

/// Limits of every world.
inline constexpr int kMaximumStateSize = 10'000;
inline constexpr int kMaximumActions = 4'000;
inline constexpr int kMaximumEpisode = 100'000;

/// How an episode ended.
enum class Ending : uint8_t {
  kNone = 0,       ///< it has not ended
  kTerminal = 1,   ///< in a state from which nothing more is earned
  kTruncated = 2,  ///< only because it was long enough; the last state has a value like any other
};

struct StepResult {
  double reward = 0;
  Ending ending = Ending::kNone;
  bool terminal() const { return ending == Ending::kTerminal; }
};

/// One episode at a time. Only one thread at a time may use an object. Does not allocate after construction.
class Environment {
 public:
  virtual ~Environment() = default;

  /// Begins the episode that the seed determines.
  virtual void Reset(uint64_t seed) = 0;

  /// Takes an action, 0 to actions - 1, also one that the mask forbids. CHECKs that the episode has not
  /// ended.
  virtual StepResult Step(int action) = 0;

  /// Writes the fields of the present state, in the order of WorldDescription::state. They are finite.
  virtual void WriteState(std::span<float> state) const = 0;

  /// Writes 1 to mask[a] if action a is allowed now, otherwise 0. At least one action is allowed.
  virtual void WriteMask(std::span<uint8_t> mask) const;

  /// Goes on from where `other`, an environment of the same world, is. CHECKs WorldDescription::copies.
  virtual void CopyFrom(const Environment& other);
};

/// A range of actions, from `first` to before `end`.
struct ActionRange {
  int first = 0;
  int end = 0;
};

/// Immutable after construction, so any number of threads may share one.
class World {
 public:
  /// CHECKs that the description is complete and within the limits.
  explicit World(WorldDescription description);
  virtual ~World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const WorldDescription& description() const { return description_; }
  int state_size() const { return static_cast<int>(description_.state.size()); }
  int observation_size() const { return description_.observation_size; }
  int actions() const { return static_cast<int>(description_.actions.size()); }
  Preference preference(size_t field) const {
    return description_.preferences.empty() ? Preference::kOnlyEqual : description_.preferences[field];
  }
  int longest_episode() const { return description_.longest_episode; }

  /// A new environment; `this` must outlive it. Call Reset before anything else.
  virtual std::unique_ptr<Environment> NewEnvironment() const = 0;

  /// Writes what the network sees of a state. A pure function of the state's fields, so actor and learner get
  /// the same bits.
  virtual void Observe(std::span<const float> state, std::span<float> observation) const = 0;

  /// What Observe and WriteMask compute, as formulas, which are added to the list. They give the same bits,
  /// but for a mask that rounding to a state's precision decides. None if the world can't state them.
  virtual std::optional<StateFormulas> Formulate(Formulas& formulas) const;

  /// Writes the figures of a complete episode, in the order of WorldDescription::figures. The default is for
  /// a world with one figure, the return: the sum of the rewards.
  virtual void Judge(const Episode& episode, std::span<double> figures) const;
  /// Whether a complete episode succeeded.
  virtual bool Succeeded(const Episode& episode) const = 0;
  /// Tells a complete episode. The default: success, number of steps and figures; for each state its number,
  /// 0, 1, ..., its fields, the action taken in it and the reward, which the last state does not have.
  virtual EpisodeAccount Tell(const Episode& episode) const;

  /// Known policies to compare an agent with; the default is none.
  virtual std::vector<ReferencePolicy> reference_policies() const { return {}; }
  /// The episode of a seed as the reference policy with this name acts in it. CHECKs that there is one.
  virtual Episode FlyReference(const std::string& name, uint64_t seed) const;
  /// Names what this episode is compared within, e.g. "3 sensors"; empty if all episodes are alike.
  virtual std::string GroupOf(const Episode& episode) const;

  /// Throws UsageError that names what is out of range if a policy that learned in this world is not made for
  /// the episodes of `other`. The default: it is made for every world in which its network fits.
  virtual void CheckServes(const World& other) const;

  /// Excursions (schedule.excursion_share): places that an agent can set out for. The default is a world
  /// without any.
  virtual bool has_places() const { return false; }
  /// Draws a place, 0, 1, ...
  virtual int DrawPlace(RandomStream& stream) const;
  virtual bool IsAt(std::span<const float> state, int place) const;
  /// The actions that lead from a state towards a place, or that stay there.
  virtual ActionRange Towards(std::span<const float> state, int place) const;

  /// The memory of the object, bytes.
  virtual int64_t bytes() const { return 0; }

 private:
  WorldDescription description_;
};

}  // namespace fresco
