// The UAV's world with a new field in every episode: the episode's seed draws the sensors and, if the ranges
// say so, the radius, the slots, the start and the stop. A state says its whole field, so that what the
// network sees is a function of the state. Immutable after construction, so any number of threads may share
// one.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "worlds/episode.h"
#include "worlds/uav/map_input.h"
#include "worlds/uav/uav_world.h"

namespace fresco {

/// Numbers from `minimum` to `maximum`, both included, all alike.
template <class Number>
struct Interval {
  Number minimum{};
  Number maximum{};
};

/// What differs from field to field.
struct FieldRanges {
  Interval<int> sensors;               ///< N; they are anywhere (RandomSensors)
  Interval<double> weight;             ///< of each sensor
  Interval<double> coverage_radius_m;  ///< R
  Interval<int> slots;                 ///< T
  /// Every cell is as likely (with a map: of its cells of kind kStartAndLanding, or, if it has none, of those
  /// that flights from the scenario's start lead to); otherwise always the scenario's.
  bool any_start = false;
  bool any_stop = false;
};

/// Where each field is in a state as floats, besides those of UavWorld. `most` is the largest N: a state has
/// room for so many sensors, and zeros for those that its field does not have.
struct UavFieldsLayout {
  size_t most = 1;
  size_t slots() const { return kAoiField + most; }
  size_t coverage_radius_m() const { return slots() + 1; }
  size_t start() const { return slots() + 2; }                             ///< column, row
  size_t stop() const { return slots() + 4; }                              ///< column, row
  size_t sensor(size_t number) const { return slots() + 6 + 3 * number; }  ///< x_m, y_m, weight
  size_t size() const { return sensor(most); }
};

class UavFields : public World {
 public:
  /// `common` has what the ranges do not name; its sensors, radius and slots are ignored. Throws UsageError
  /// as UavWorld does, also if a field could be drawn whose stop can't be reached in time and energy.
  UavFields(Scenario common, FieldRanges ranges, UavOptions options = {});

  std::unique_ptr<Environment> NewEnvironment() const override;
  /// WriteSets (network_input.h) of the field that the state says.
  void Observe(std::span<const float> state, std::span<float> observation) const override;
  /// None over a map.
  std::optional<StateFormulas> Formulate(Formulas& formulas) const override;
  /// These four are those of the episode's field.
  void Judge(const Episode& episode, std::span<double> figures) const override;
  bool Succeeded(const Episode& episode) const override;
  EpisodeAccount Tell(const Episode& flight) const override;
  /// The map and what the network sees of it.
  int64_t bytes() const override;
  /// Those of the episode's field.
  std::vector<ReferencePolicy> reference_policies() const override;
  Episode FlyReference(const std::string& name, uint64_t seed) const override;
  /// `other` must be a field within the ranges, or one of such fields in every episode.
  void CheckServes(const World& other) const override;
  /// The number of sensors: "3 sensors".
  std::string GroupOf(const Episode& episode) const override;
  bool has_places() const override { return true; }
  int DrawPlace(RandomStream& stream) const override;
  bool IsAt(std::span<const float> state, int place) const override;
  ActionRange Towards(std::span<const float> state, int place) const override;

  /// The field of an episode's seed.
  Scenario Draw(uint64_t seed) const;
  /// The field that a state says.
  Scenario FieldIn(std::span<const float> state) const;
  /// The field of an episode as a world, and the episode as one of that world.
  std::unique_ptr<const UavWorld> WorldOf(const Episode& episode) const;
  Episode InItsField(const UavWorld& field, const Episode& episode) const;
  /// The field of an episode's seed as a world, and a flight there as the episode of that seed.
  std::unique_ptr<const UavWorld> WorldOf(uint64_t seed) const;
  Episode FromItsField(const UavWorld& field, uint64_t seed, const Episode& flight) const;

  const UavOptions& options() const { return options_; }
  UavFieldsLayout layout() const { return {static_cast<size_t>(ranges_.sensors.maximum)}; }
  /// The index of an action is that of a world with the most sensors.
  int schedules() const { return ranges_.sensors.maximum + 1; }
  /// The action in a field with so many sensors. Scheduling a sensor that the field does not have is
  /// scheduling none.
  Action ActionAt(int index, int sensors) const;
  /// Writes the fields of a state that say the field.
  void WriteField(const Scenario& field, std::span<float> state) const;

 private:
  void CheckEveryStopIsReachable() const;
  void CheckServesField(const UavWorld& field) const;
  std::vector<int> DistancesToStops(const UavWorld& largest) const;
  const std::vector<Cell>& CellsToDraw() const;
  Cell DrawStart(bool any, Cell given, RandomStream& stream) const;

  Scenario common_;
  FieldRanges ranges_;
  UavOptions options_;
  std::optional<MapInput> map_input_;  // if there is a map
};

/// The world as UavFields; null if it is another kind of world.
const UavFields* AsUavFields(const World& world);

/// A flight and the field that it is over.
struct FlightOverField {
  std::shared_ptr<const UavWorld> field;
  Episode flight;  ///< an episode of `field`
};

/// Whether episodes of the world are flights: it is UavWorld or UavFields.
bool HasFlights(const World& world);

/// An episode as a flight over its field. The field of UavWorld is the world itself, which must outlive the
/// result. CHECKs HasFlights.
FlightOverField OverItsField(const World& world, const Episode& episode);

}  // namespace fresco
