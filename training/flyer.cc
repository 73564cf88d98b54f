#include "training/flyer.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/memory.h"

namespace fresco {

Flyer::Flyer(const Experiment& experiment, int capacity)
    : experiment_(experiment),
      double_dqn_(experiment.agent().double_dqn()),
      discount_(static_cast<float>(experiment.agent().discount())),
      excursion_share_(experiment.schedule().excursion_share()),
      capacity_(capacity),
      current_workspace_(experiment.network()->NewWorkspace(capacity, NetworkWorkspace::Passes::kForward)),
      target_workspace_(experiment.network()->NewWorkspace(capacity, NetworkWorkspace::Passes::kForward)) {
  if (experiment.schedule().has_search()) {
    search_.emplace(experiment, experiment.schedule().search().width());
  }
}

int64_t Flyer::BytesFor(const Experiment& experiment, int capacity, int64_t flights) {
  constexpr int64_t kGrowth = 2;  // a vector that grows may have twice the room that it needs
  const World& world = experiment.world();
  const int64_t of_flight =
      static_cast<int64_t>(sizeof(Flight)) + HeapBytes(world.actions()) + kGrowth * LongestResultBytes(world);
  return 2 * experiment.network()->WorkspaceBytes(capacity, NetworkWorkspace::Passes::kForward) +
         flights * of_flight +
         (experiment.schedule().has_search()
              ? BeamSearch::BytesFor(experiment, experiment.schedule().search().width())
              : 0);
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

std::pair<int32_t, int32_t> Flyer::Versions(const Flight& flight) {
  return {flight.order.current_version, flight.order.target_version};
}

std::unique_ptr<Flyer::Flight> Flyer::FreeFlight() {
  if (free_flights_.empty()) {
    return std::make_unique<Flight>(experiment_.world());
  }
  std::unique_ptr<Flight> flight = std::move(free_flights_.back());
  free_flights_.pop_back();
  return flight;
}

void Flyer::Start(const Order& order, SharedParameters current, SharedParameters target) {
  FRESCO_CHECK(HasRoom() && current != nullptr && target != nullptr);
  FRESCO_CHECK(order.search_width == 0 || (search_ && search_->width() == order.search_width));
  std::unique_ptr<Flight> flight = FreeFlight();
  flight->order = order;
  flight->current = std::move(current);
  flight->target = std::move(target);
  flight->recorder.Begin(order.seed);
  flight->result.td_errors.clear();
  flight->place.reset();
  flight->plan.clear();
  flight->done = false;
  const auto behind =
      std::upper_bound(flights_.begin(), flights_.end(), Versions(*flight),
                       [](const auto& versions, const auto& other) { return versions < Versions(*other); });
  flights_.insert(behind, std::move(flight));
}

void Flyer::Step(const std::function<void(const Order&, const OrderResult&)>& finished) {
  StepSearch();
  stepping_.clear();
  for (const auto& flight : flights_) {
    if (!WaitsForSearch(*flight)) {
      stepping_.push_back(flight.get());
    }
  }
  for (size_t begin = 0; begin < stepping_.size();) {
    const Flight& first = *stepping_[begin];
    size_t end = begin + 1;
    while (end < stepping_.size() && stepping_[end]->current == first.current &&
           stepping_[end]->target == first.target) {
      ++end;
    }
    StepGroup(std::span(stepping_).subspan(begin, end - begin));
    begin = end;
  }
  std::erase_if(flights_, [&](auto& flight) {
    if (!flight->done) {
      return false;
    }
    Finish(*flight, finished);
    free_flights_.push_back(std::move(flight));
    return true;
  });
}

void Flyer::Finish(Flight& flight, const std::function<void(const Order&, const OrderResult&)>& finished) {
  flight.current.reset();
  flight.target.reset();
  flight.result.order_index = flight.order.index;
  flight.result.seed = flight.order.seed;
  flight.result.episode = flight.recorder.Release();
  finished(flight.order, flight.result);
  flight.recorder.Reuse(std::move(flight.result.episode));
}

bool Flyer::WaitsForSearch(const Flight& flight) {
  return flight.order.search_width > 0 && flight.plan.empty() && !flight.recorder.ended() &&
         flight.recorder.episode().transitions() >= flight.order.search_from;
}

/// Makes the search of one flight a step longer, so that other work is never far away.
void Flyer::StepSearch() {
  if (searching_ == nullptr) {
    const auto waiting = std::find_if(flights_.begin(), flights_.end(),
                                      [](const auto& flight) { return WaitsForSearch(*flight); });
    if (waiting == flights_.end()) {
      return;
    }
    searching_ = waiting->get();
    search_->Begin(searching_->order.seed, searching_->current, searching_->recorder.episode().actions);
  }
  if (!search_->Step()) {
    searching_->plan = search_->BestActions();
    searching_ = nullptr;
  }
}

void Flyer::StepGroup(std::span<Flight* const> group) {
  const auto batch = static_cast<int>(group.size());
  Matrix& observations = current_workspace_->input();
  for (int column = 0; column < batch; ++column) {
    experiment_.world().Observe(
        group[static_cast<size_t>(column)]->recorder.state(),
        {observations.col(column).data(), static_cast<size_t>(experiment_.world().observation_size())});
  }
  target_workspace_->input().leftCols(batch) = observations.leftCols(batch);
  const auto forward = [&](const SharedParameters& parameters, NetworkWorkspace& workspace) {
    experiment_.network()->Forward(Values(*parameters), {0, batch}, workspace);
  };
  forward(group.front()->current, *current_workspace_);
  forward(group.front()->target, *target_workspace_);
  for (int column = 0; column < batch; ++column) {
    Flight& flight = *group[static_cast<size_t>(column)];
    FinishLastTransition(flight, column);
    if (flight.recorder.ended()) {  // it was cut off, so the value of its last state counted
      flight.done = true;
      continue;
    }
    const int action = ChooseAction(flight, column);
    Act(flight, action, current_workspace_->output()(action, column));
  }
}

void Flyer::FinishLastTransition(Flight& flight, int column) {
  const std::vector<float>& rewards = flight.recorder.episode().rewards;
  if (rewards.empty()) {
    return;
  }
  const Matrix& target_values = target_workspace_->output();
  const Matrix& choosing = double_dqn_ ? current_workspace_->output() : target_values;
  const float next_value = target_values(GreedyAction(choosing, column, flight.recorder.mask()), column);
  flight.result.td_errors.back() = rewards.back() + discount_ * next_value - flight.chosen_value;
}

int Flyer::ChooseAction(Flight& flight, int column) const {
  if (!flight.plan.empty()) {
    return flight.plan[static_cast<size_t>(flight.recorder.episode().transitions())];
  }
  const std::optional<int> exploring = Explore(flight, column);
  return exploring ? *exploring : GreedyAction(current_workspace_->output(), column, flight.recorder.mask());
}

/// Returns a random action, or one of an excursion: a straight way to a random place, with the best of the
/// actions that lead there. An excursion ends there, or earlier if the mask forbids these actions. Returns
/// nothing if the flight shall act greedily.
std::optional<int> Flyer::Explore(Flight& flight, int column) const {
  const World& world = experiment_.world();
  const std::span<const float> state = flight.recorder.state();
  const std::vector<uint8_t>& mask = flight.recorder.mask();
  const auto slot = static_cast<uint32_t>(flight.recorder.episode().transitions() + 1);
  RandomStream stream(flight.order.seed, RandomPurpose::kActing, slot, 0);
  if (flight.place && world.IsAt(state, *flight.place)) {
    flight.place.reset();
  }
  if (!flight.place) {
    if (stream.NextUniform() >= flight.order.epsilon) {
      return std::nullopt;
    }
    if (excursion_share_ == 0 || stream.NextUniform() >= excursion_share_) {
      return RandomAllowedAction(mask, stream);
    }
    flight.place = world.DrawPlace(stream);
  }
  const ActionRange range = world.Towards(state, *flight.place);
  const std::optional<int> action =
      BestAllowedAction(current_workspace_->output(), column, mask, range.first, range.end);
  if (!action) {
    flight.place.reset();
  }
  return action;
}

void Flyer::Act(Flight& flight, int action, float value) {
  flight.recorder.Step(action);
  flight.chosen_value = value;
  // Final if this state is terminal; otherwise FinishLastTransition replaces it.
  flight.result.td_errors.push_back(flight.recorder.episode().rewards.back() - value);
  flight.done = flight.recorder.episode().ending == Ending::kTerminal;
}

Episode FlyGreedily(const Experiment& experiment, uint64_t seed, SharedParameters parameters) {
  Flyer flyer(experiment, 1);
  Order order;
  order.kind = OrderKind::kEvaluate;
  order.seed = seed;
  flyer.Start(order, parameters, parameters);
  Episode flown;
  while (!flyer.Idle()) {
    flyer.Step([&](const Order&, const OrderResult& result) { flown = result.episode; });
  }
  return flown;
}

}  // namespace fresco
