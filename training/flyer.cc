#include "training/flyer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/memory.h"

namespace fresco {
namespace {

/// The `number`-th allowed action, counted from 0.
int AllowedAction(const std::vector<uint8_t>& mask, uint32_t number) {
  for (size_t action = 0; action < mask.size(); ++action) {
    if (mask[action] != 0 && number-- == 0) {
      return static_cast<int>(action);
    }
  }
  FRESCO_CHECK(false);
}

/// The first allowed action of the largest value among those from `first` to before `end`.
std::optional<int> BestAllowedAction(const Matrix& values, int column, const std::vector<uint8_t>& mask,
                                     int first, int end) {
  std::optional<int> best;
  for (int action = first; action < end; ++action) {
    if (mask[static_cast<size_t>(action)] != 0 && (!best || values(action, column) > values(*best, column))) {
      best = action;
    }
  }
  return best;
}

int GreedyAction(const Matrix& values, int column, const std::vector<uint8_t>& mask) {
  const std::optional<int> best = BestAllowedAction(values, column, mask, 0, static_cast<int>(mask.size()));
  FRESCO_CHECK(best);
  return *best;
}

}  // namespace

Flyer::Flight::Flight(const World& world, const Order& flown_order, SharedParameters current_parameters,
                      SharedParameters target_parameters)
    : order(flown_order),
      current(std::move(current_parameters)),
      target(std::move(target_parameters)),
      environment(world),
      mask(static_cast<size_t>(world.actions())) {
  episode.order_index = order.index;
}

Flyer::Flyer(const World& world, const Experiment& experiment, int capacity)
    : world_(&world),
      network_input_(world, experiment.network_input_options()),
      mlp_(experiment.network_shape()),
      mask_options_(experiment.mask_options()),
      double_dqn_(experiment.agent().double_dqn()),
      discount_(static_cast<float>(experiment.agent().discount())),
      excursion_share_(experiment.schedule().excursion_share()),
      capacity_(capacity),
      current_workspace_(mlp_.shape(), capacity),
      target_workspace_(mlp_.shape(), capacity) {}

int64_t Flyer::BytesFor(const World& world, const Experiment& experiment, int capacity, int64_t flights) {
  constexpr int64_t kGrowth = 2;  // a vector that grows may have twice the room that it needs
  const MlpShape shape = experiment.network_shape();
  const int64_t of_flight = static_cast<int64_t>(sizeof(Flight)) + HeapBytes(world.actions()) +
                            kGrowth * LongestEpisodeBytes(world);
  return NetworkInput::BytesFor(world, experiment.network_input_options()) +
         2 * MlpWorkspace::BytesFor(shape, capacity, false) + flights * of_flight;
}

bool Flyer::IsFlying(int64_t order_index) const {
  return std::any_of(flights_.begin(), flights_.end(),
                     [&](const auto& flight) { return flight->order.index == order_index; });
}

std::vector<int64_t> Flyer::OrderIndices() const {
  std::vector<int64_t> indices;
  for (const auto& flight : flights_) {
    indices.push_back(flight->order.index);
  }
  return indices;
}

void Flyer::Start(const Order& order, SharedParameters current, SharedParameters target) {
  FRESCO_CHECK(HasRoom() && current != nullptr && target != nullptr);
  auto& flight =
      flights_.emplace_back(std::make_unique<Flight>(*world_, order, std::move(current), std::move(target)));
  flight->environment.Reset();
  flight->environment.WriteMask(mask_options_, flight->mask);
  flight->episode.states.push_back(flight->environment.state());
}

void Flyer::Step(const std::function<void(const Order&, const Episode&)>& finished) {
  // Flights of the same two versions stand side by side; the order within a group has no influence.
  std::stable_sort(flights_.begin(), flights_.end(), [](const auto& a, const auto& b) {
    return std::pair(a->order.current_version, a->order.target_version) <
           std::pair(b->order.current_version, b->order.target_version);
  });
  for (size_t begin = 0; begin < flights_.size();) {
    group_.clear();
    const Flight& first = *flights_[begin];
    for (; begin < flights_.size() && flights_[begin]->current == first.current &&
           flights_[begin]->target == first.target;
         ++begin) {
      group_.push_back(flights_[begin].get());
    }
    StepGroup(group_);
  }
  for (const auto& flight : flights_) {
    if (flight->episode.outcome != Outcome::kFlying) {
      finished(flight->order, flight->episode);
    }
  }
  std::erase_if(flights_, [](const auto& flight) { return flight->episode.outcome != Outcome::kFlying; });
}

void Flyer::StepGroup(std::vector<Flight*>& group) {
  const int batch = static_cast<int>(group.size());
  const auto forward = [&](const SharedParameters& parameters, MlpWorkspace& workspace) {
    for (int column = 0; column < batch; ++column) {
      network_input_.Write(
          group[static_cast<size_t>(column)]->environment.state(),
          {workspace.input().col(column).data(), static_cast<size_t>(network_input_.size())});
    }
    mlp_.Forward({parameters->data(), static_cast<size_t>(parameters->size())}, batch, workspace);
  };
  forward(group.front()->current, current_workspace_);
  forward(group.front()->target, target_workspace_);
  for (int column = 0; column < batch; ++column) {
    Flight& flight = *group[static_cast<size_t>(column)];
    FinishLastTransition(flight, column);
    const int action = ChooseAction(flight, column);
    Act(flight, action, current_workspace_.output()(action, column));
  }
}

void Flyer::FinishLastTransition(Flight& flight, int column) {
  if (flight.episode.rewards.empty()) {
    return;
  }
  const Matrix& target_values = target_workspace_.output();
  const Matrix& choosing = double_dqn_ ? current_workspace_.output() : target_values;
  const float next_value = target_values(GreedyAction(choosing, column, flight.mask), column);
  flight.episode.td_errors.back() =
      flight.episode.rewards.back() + discount_ * next_value - flight.chosen_value;
}

int Flyer::ChooseAction(Flight& flight, int column) const {
  const std::optional<int> exploring = Explore(flight, column);
  return exploring ? *exploring : GreedyAction(current_workspace_.output(), column, flight.mask);
}

/// A random action, or one of an excursion: a straight flight to a random cell, scheduling greedily. It
/// ends there, or where the mask does not let it go on. Nothing where the greedy action is due.
std::optional<int> Flyer::Explore(Flight& flight, int column) const {
  const State& state = flight.environment.state();
  RandomStream stream(flight.order.seed, RandomPurpose::kActing, static_cast<uint32_t>(state.slot), 0);
  if (flight.waypoint == state.cell) {
    flight.waypoint.reset();
  }
  if (!flight.waypoint) {
    if (stream.NextUniform() >= flight.order.epsilon) {
      return std::nullopt;
    }
    if (excursion_share_ == 0 || stream.NextUniform() >= excursion_share_) {
      const auto allowed = static_cast<uint32_t>(std::count(flight.mask.begin(), flight.mask.end(), 1));
      return AllowedAction(flight.mask, stream.NextBelow(allowed));
    }
    flight.waypoint = RandomCell(stream);
  }
  const int first = world_->ActionIndex({MoveTowards(state.cell, *flight.waypoint), 0});
  const std::optional<int> action = BestAllowedAction(current_workspace_.output(), column, flight.mask, first,
                                                      first + world_->sensors() + 1);
  if (!action) {
    flight.waypoint.reset();
  }
  return action;
}

Cell Flyer::RandomCell(RandomStream& stream) const {
  const int column = static_cast<int>(stream.NextBelow(static_cast<uint32_t>(world_->scenario().columns)));
  const int row = static_cast<int>(stream.NextBelow(static_cast<uint32_t>(world_->scenario().rows)));
  return {column, row};
}

void Flyer::Act(Flight& flight, int action, float value) {
  const StepResult result = flight.environment.Step(world_->ActionAt(action));
  flight.chosen_value = value;
  Episode& episode = flight.episode;
  episode.actions.push_back(static_cast<int16_t>(action));
  episode.rewards.push_back(static_cast<float>(result.reward));
  episode.td_errors.push_back(episode.rewards.back() - value);  // final where the episode ends here
  episode.states.push_back(flight.environment.state());
  episode.outcome = result.outcome;
  flight.environment.WriteMask(mask_options_, flight.mask);
  AppendMask(flight.mask, episode.next_masks);
}

Episode FlyGreedily(const World& world, const Experiment& experiment, SharedParameters parameters) {
  Flyer flyer(world, experiment, 1);
  Order order;
  order.kind = OrderKind::kEvaluate;
  flyer.Start(order, parameters, parameters);
  Episode flown;
  while (!flyer.Idle()) {
    flyer.Step([&](const Order&, const Episode& episode) { flown = episode; });
  }
  return flown;
}

}  // namespace fresco
