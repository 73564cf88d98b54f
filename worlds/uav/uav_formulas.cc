#include "worlds/uav/uav_formulas.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "worlds/uav/obstacle_map.h"
#include "worlds/uav/ways.h"

namespace fresco {
namespace {

/// Which moves the mask allows [5]. `closer` and `possible`, [4] each: whether a move to the north, south,
/// east or west leads closer to the stop, and whether it can be made at all.
Term AllowedMoves(const UavWorld& world, Term closer, Term possible, Formulas& formulas) {
  if (!world.mask_options().safe_actions) {
    return formulas.Single({1, 1, 1, 1, 1});
  }
  // The energy margin that a move closer, a hover and a move away need, by the time margin. It does not
  // depend on the distance to the stop: here it is 1.
  std::vector<double> needed_j;
  for (int time_margin = 0; time_margin <= world.scenario().slots; ++time_margin) {
    const int slots_left = time_margin + 1;
    for (const int distance : {0, 1, 2}) {
      const double move_j = distance == 1 ? world.hovering_energy_j() : world.flying_energy_j();
      const double more_j =
          move_j + CompletionEnergy(world, distance, slots_left - 1) + EnergyMargin(world, 1, slots_left, 0);
      needed_j.push_back(distance <= slots_left - 1 ? more_j : std::numeric_limits<float>::max());
    }
  }
  const Term time_margin = Largest(formulas.State(kTimeMarginField, 1), 0.0);
  const Term safe = AtMost(formulas.Row(needed_j, 3, time_margin), formulas.State(kEnergyMarginField, 1));
  const Term moves = possible * Choose(closer, Part(safe, 0, 1), Part(safe, 2, 1));
  const Term allowed = formulas.Join({moves, Part(safe, 1, 1)});
  return Largest(allowed, AtMost(Sum(allowed), 0.0));  // if nothing is safe, everything is allowed
}

/// The mask of all actions. `schedules`: whether none and each sensor may be scheduled.
Term MaskOfActions(Term moves, Term schedules, Formulas& formulas) {
  std::vector<Term> parts;
  for (int move = 0; move < kMoves; ++move) {
    parts.push_back(Part(moves, move, 1) * schedules);
  }
  return formulas.Join(parts);
}

/// The mask where everything that depends on the cell is in a table.
Term MaskOfField(const UavWorld& world, Term cell, Formulas& formulas) {
  std::vector<double> moves;
  const MaskOptions& options = world.mask_options();
  std::vector<double> schedules;
  for (int index = 0; index < world.scenario().columns * world.scenario().rows; ++index) {
    const Cell here = {index % world.scenario().columns, index / world.scenario().columns};
    std::vector<double> possible;
    for (int move = 0; move < 4; ++move) {
      const Cell step = kMoveSteps[static_cast<size_t>(move)];
      const Cell next = {here.column + step.column, here.row + step.row};
      possible.push_back(world.MayFly(next) ? 1 : 0);
      moves.push_back(world.MayFly(next) && world.DistanceToStop(next) < world.DistanceToStop(here) ? 1 : 0);
    }
    moves.insert(moves.end(), possible.begin(), possible.end());
    const std::span<const uint8_t> coverage = world.Coverage(here);
    const bool covers_one =
        std::any_of(coverage.begin(), coverage.end(), [](uint8_t covered) { return covered != 0; });
    schedules.push_back(options.idle && covers_one ? 0 : 1);
    for (const uint8_t covered : coverage) {
      schedules.push_back(covered != 0 || !options.coverage ? 1 : 0);
    }
  }
  const Term of_cell = formulas.Row(std::move(moves), 8, cell);
  return MaskOfActions(AllowedMoves(world, Part(of_cell, 0, 4), Part(of_cell, 4, 4), formulas),
                       formulas.Row(std::move(schedules), world.sensors() + 1, cell), formulas);
}

/// Entries of an observation that are fields of the state in other units.
struct ScaledFields {
  int first = 0;  // entry
  Term value;
  int count = 0;
};

std::vector<ScaledFields> ScaledFieldsOf(const UavWorld& world, Formulas& formulas) {
  const double slots = world.scenario().slots;
  const Term time = formulas.State(kTimeMarginField, 1) / slots;
  const Term energy = formulas.State(kEnergyMarginField, 1) / world.scenario().initial_energy_j;
  const auto ages = [&](int first, int count) {
    return formulas.State(static_cast<int>(kAoiField) + first, count) / slots;
  };
  const int sensors = world.sensors();
  if (!world.description().sets) {
    return {{2, ages(0, sensors), sensors}, {2 + sensors, time, 1}, {3 + sensors, energy, 1}};
  }
  const ObservationSets& sets = *world.description().sets;
  std::vector<ScaledFields> fields = {{kTimeMarginInput, time, 1}, {kEnergyMarginInput, energy, 1}};
  for (int sensor = 0; sensor < sensors; ++sensor) {
    fields.push_back({sets.own_inputs + sensor * sets.item_inputs + kAoiInput, ages(sensor, 1), 1});
  }
  return fields;
}

/// The observation: a row of a table, with the scaled fields in their places.
Term ObservationOfField(const UavWorld& world, Term cell, Formulas& formulas) {
  const auto inputs = static_cast<size_t>(world.observation_size());
  std::vector<double> table;
  std::vector<float> observation(inputs);
  for (int index = 0; index < world.scenario().columns * world.scenario().rows; ++index) {
    const Cell here = {index % world.scenario().columns, index / world.scenario().columns};
    std::fill(observation.begin(), observation.end(), 0.0f);
    if (world.MayFly(here)) {
      std::vector<float> state(static_cast<size_t>(world.state_size()));
      state[kColumnField] = static_cast<float>(here.column);
      state[kRowField] = static_cast<float>(here.row);
      world.Observe(state, observation);
    }
    table.insert(table.end(), observation.begin(), observation.end());
  }
  const Term row = formulas.Row(std::move(table), static_cast<int>(inputs), cell);
  std::vector<Term> parts;
  int next = 0;
  const auto add_row_until = [&](int end) {
    if (end > next) {
      parts.push_back(Part(row, next, end - next));
    }
  };
  for (const ScaledFields& fields : ScaledFieldsOf(world, formulas)) {
    add_row_until(fields.first);
    parts.push_back(fields.value);
    next = fields.first + fields.count;
  }
  add_row_until(static_cast<int>(inputs));
  return formulas.Join(parts);
}

Term Magnitude(Term a) {
  return Largest(a, -a);
}

/// The largest entry.
Term LargestEntry(Term a, int size) {
  while (size > 1) {
    const int half = (size + 1) / 2;
    a = Largest(Part(a, 0, half), Part(a, size - half, half));
    size = half;
  }
  return a;
}

/// WriteWays (ways.h), with the length from the cell and then from the cells after the four moves.
Term InputsOfWays(Term lengths, int longer_side, Formulas& formulas) {
  const Term length = Part(lengths, 0, 1);
  const Term at_most_two_sides = -Largest(-length, -2.0 * longer_side);
  return formulas.Join({at_most_two_sides / longer_side, length - Part(lengths, 1, 4)});
}

/// The ways over an open grid.
class OpenWays {
 public:
  OpenWays(const Scenario& scenario, Term column, Term row, Formulas& formulas)
      : scenario_(&scenario), formulas_(&formulas) {
    const auto after_moves = [&](Term position, std::vector<double> steps, int last) {
      const Term not_below_zero = Largest(position + formulas.Single(std::move(steps)), 0.0);
      return last - Largest(last - not_below_zero, 0.0);
    };
    columns_ = after_moves(column, {0, 0, 0, 1, -1}, scenario.columns - 1);
    rows_ = after_moves(row, {0, 1, -1, 0, 0}, scenario.rows - 1);
    std::vector<double> all_columns;
    std::vector<double> all_rows;
    for (int index = 0; index < CellCount(); ++index) {
      all_columns.push_back(index % scenario.columns);
      all_rows.push_back(index / scenario.columns);
    }
    const Term cell_columns = formulas.Single(std::move(all_columns));
    const Term cell_rows = formulas.Single(std::move(all_rows));
    cells_east_m_ = ToDouble(cell_columns) * scenario.cell_m;
    cells_north_m_ = ToDouble(cell_rows) * scenario.cell_m;
    for (int i = 0; i < static_cast<int>(kWayInputs); ++i) {
      moves_.push_back(Magnitude(cell_columns - Part(columns_, i, 1)) +
                       Magnitude(cell_rows - Part(rows_, i, 1)));
    }
  }

  Term ToStop(Term stop_column, Term stop_row) const {
    return Inputs(Magnitude(columns_ - stop_column) + Magnitude(rows_ - stop_row));
  }

  /// `reach_m`: the coverage radius with the tolerance of IsWithin.
  Term ToSensor(Term x_m, Term y_m, Term reach_m) const {
    const Term east_m = cells_east_m_ - x_m;
    const Term north_m = cells_north_m_ - y_m;
    const Term covers = ToSingle(AtMost(SquareRoot(east_m * east_m + north_m * north_m), reach_m));
    std::vector<Term> lengths;
    for (const Term moves : moves_) {
      lengths.push_back(
          -LargestEntry(Choose(1.0 - covers, -1.0 * ObstacleMap::kCutOff, -moves), CellCount()));
    }
    return Inputs(formulas_->Join(lengths));
  }

 private:
  int CellCount() const { return scenario_->columns * scenario_->rows; }
  Term Inputs(Term lengths) const {
    return InputsOfWays(lengths, std::max(scenario_->columns, scenario_->rows), *formulas_);
  }

  const Scenario* scenario_;
  Formulas* formulas_;
  Term columns_;  // [5]: of the UAV, and after each move
  Term rows_;
  Term cells_east_m_;  // of every cell
  Term cells_north_m_;
  std::vector<Term> moves_;  // [5], from there to every cell
};

}  // namespace

StateFormulas FormulasOfField(const UavWorld& world, Formulas& formulas) {
  const Term cell = formulas.State(kRowField, 1) * world.scenario().columns + formulas.State(kColumnField, 1);
  return {ObservationOfField(world, cell, formulas), MaskOfField(world, cell, formulas)};
}

StateFormulas FormulasOfFields(const UavWorld& largest, const UavFieldsLayout& layout, Formulas& formulas) {
  const Scenario& scenario = largest.scenario();
  FRESCO_CHECK(scenario.map == nullptr);
  const auto state = [&](size_t first) { return formulas.State(static_cast<int>(first), 1); };
  const Term column = state(kColumnField);
  const Term row = state(kRowField);
  const Term stop_column = state(layout.stop());
  const Term stop_row = state(layout.stop() + 1);
  const Term slots = state(layout.slots());
  const Term radius_m = ToDouble(state(layout.coverage_radius_m()));
  const double longer_side = std::max(scenario.columns, scenario.rows);
  const auto cells = [&](Term count) { return ToSingle(ToDouble(count) / longer_side); };
  const auto metres = [&](Term length_m) { return ToSingle(length_m / (longer_side * scenario.cell_m)); };

  const OpenWays ways(scenario, column, row, formulas);

  std::vector<Term> weights;
  for (size_t sensor = 0; sensor < layout.most; ++sensor) {
    weights.push_back(state(layout.sensor(sensor) + 2));
  }
  const Term total_weight = Sum(Floor(ToDouble(formulas.Join(weights)) * kPartsOfWeight)) / kPartsOfWeight;

  std::vector<Term> observation = {cells(column),
                                   cells(row),
                                   cells(stop_column - column),
                                   cells(stop_row - row),
                                   state(kTimeMarginField) / slots,
                                   state(kEnergyMarginField) / scenario.initial_energy_j,
                                   metres(radius_m),
                                   ways.ToStop(stop_column, stop_row)};
  std::vector<Term> covers;
  std::vector<Term> sensors;  // which of them may be scheduled
  const Term east_m = ToDouble(column) * scenario.cell_m;
  const Term north_m = ToDouble(row) * scenario.cell_m;
  for (size_t sensor = 0; sensor < layout.most; ++sensor) {
    const Term x_m = ToDouble(state(layout.sensor(sensor)));
    const Term y_m = ToDouble(state(layout.sensor(sensor) + 1));
    const Term is_absent = AtMost(weights[sensor], 0.0);
    const Term distance_m = SquareRoot((east_m - x_m) * (east_m - x_m) + (north_m - y_m) * (north_m - y_m));
    const Term reach_m = radius_m * kRadiusLeeway;  // IsWithin
    const Term is_covered = ToSingle(AtMost(distance_m, reach_m));
    const Term item =
        formulas.Join({formulas.Single({1}), metres(x_m - east_m), metres(y_m - north_m), metres(distance_m),
                       is_covered, state(kAoiField + sensor) / slots,
                       ToSingle(ToDouble(weights[sensor]) / total_weight), ways.ToSensor(x_m, y_m, reach_m)});
    observation.push_back(Choose(is_absent, 0.0, item));
    covers.push_back(Choose(is_absent, 0.0, is_covered));
    sensors.push_back(largest.mask_options().coverage ? covers.back() : 1.0 - is_absent);
  }

  // By move: north, south, east, west.
  const Term away =
      formulas.Join({stop_row - row, row - stop_row, stop_column - column, column - stop_column});
  const Term closer = AtMost(1.0, away);
  const Term room = formulas.Join({(scenario.rows - 1) - row, row, (scenario.columns - 1) - column, column});
  const Term moves = AllowedMoves(largest, closer, AtMost(1.0, room), formulas);
  const Term none =
      largest.mask_options().idle ? ToSingle(AtMost(Sum(formulas.Join(covers)), 0.0)) : formulas.Single({1});
  return {formulas.Join(observation),
          MaskOfActions(moves, formulas.Join({none, formulas.Join(sensors)}), formulas)};
}

}  // namespace fresco
