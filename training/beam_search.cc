#include "training/beam_search.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/memory.h"
#include "training/dqn.h"
#include "training/flyer.h"

namespace fresco {
namespace {

/// So many actions are tried for each partial episode that is kept: first the network's values of actions
/// choose those, then its values of the states to which they led choose the best.
constexpr size_t kTries = 4;

}  // namespace

BeamSearch::Node::Node(const World& world)
    : environment(world.NewEnvironment()),
      state(static_cast<size_t>(world.state_size())),
      mask(static_cast<size_t>(world.actions())),
      action_values(mask.size()) {}

BeamSearch::BeamSearch(const Experiment& experiment, int width)
    : experiment_(experiment), width_(static_cast<size_t>(width)) {
  FRESCO_CHECK(experiment.world().description().copies && width >= 1);
  workspace_ = experiment.network()->NewWorkspace(static_cast<int>(width_ * kTries),
                                                  NetworkWorkspace::Passes::kForward);
  for (size_t i = 0; i < width_; ++i) {
    nodes_.emplace_back(experiment.world());
  }
  for (size_t i = 0; i < width_ * kTries; ++i) {
    candidates_.emplace_back(experiment.world());
  }
}

int64_t BeamSearch::BytesFor(const Experiment& experiment, int width) {
  const World& world = experiment.world();
  const int64_t node = static_cast<int64_t>(sizeof(Node)) + HeapBytes(world.actions()) +
                       world.state_size() * static_cast<int64_t>(sizeof(float)) +
                       world.actions() * static_cast<int64_t>(sizeof(float));
  const auto tries = static_cast<int>(kTries);
  return experiment.network()->WorkspaceBytes(width * tries, NetworkWorkspace::Passes::kForward) +
         width * (1 + tries) * node + world.longest_episode() * width * static_cast<int64_t>(sizeof(Origin)) +
         int64_t{width} * world.actions() * static_cast<int64_t>(sizeof(Choice));
}

void BeamSearch::Begin(uint64_t seed, std::shared_ptr<const Vector> parameters) {
  parameters_ = std::move(parameters);
  steps_.clear();
  best_return_ = -std::numeric_limits<double>::infinity();
  best_step_ = 0;
  Node& first = candidates_.front();
  first.environment->Reset(seed);
  first.environment->WriteState(first.state);
  first.environment->WriteMask(first.mask);
  first.earned = 0;
  tried_ = {0};
  Evaluate();
  Keep();
}

bool BeamSearch::Step() {
  Choose();
  Try();
  DropRepeatedStates();
  Evaluate();
  Keep();
  return kept_ > 0;
}

/// Chooses the actions to try, those with the largest values.
void BeamSearch::Choose() {
  choices_.clear();
  for (size_t i = 0; i < kept_; ++i) {
    const Node& node = nodes_[i];
    for (size_t action = 0; action < node.mask.size(); ++action) {
      if (node.mask[action] != 0) {
        choices_.push_back({node.earned + double{node.action_values[action]},
                            {static_cast<int32_t>(i), static_cast<int16_t>(action)}});
      }
    }
  }
  const size_t count = std::min(choices_.size(), candidates_.size());
  std::partial_sort(choices_.begin(), choices_.begin() + static_cast<int64_t>(count), choices_.end(),
                    [](const Choice& a, const Choice& b) {
                      return std::tuple(-a.value, a.origin.parent, a.origin.action) <
                             std::tuple(-b.value, b.origin.parent, b.origin.action);
                    });
  choices_.resize(count);
}

/// Takes the chosen actions. Remembers the best episode that ends.
void BeamSearch::Try() {
  tried_.clear();
  for (size_t i = 0; i < choices_.size(); ++i) {
    const Origin origin = choices_[i].origin;
    const Node& parent = nodes_[static_cast<size_t>(origin.parent)];
    Node& node = candidates_[i];
    node.environment->CopyFrom(*parent.environment);
    const StepResult result = node.environment->Step(origin.action);
    node.earned = parent.earned + result.reward;
    node.origin = origin;
    if (result.ending == Ending::kNone) {
      node.environment->WriteState(node.state);
      node.environment->WriteMask(node.mask);
      tried_.push_back(i);
    } else if (node.earned > best_return_) {
      best_return_ = node.earned;
      best_step_ = steps_.size();
      best_origin_ = origin;
    }
  }
}

/// From equal states on, everything is equal. So only the one that has earned most counts.
void BeamSearch::DropRepeatedStates() {
  const auto compare = [&](size_t a, size_t b) {
    const std::vector<float>& state = candidates_[a].state;
    return std::memcmp(state.data(), candidates_[b].state.data(), state.size() * sizeof(float));
  };
  std::sort(tried_.begin(), tried_.end(), [&](size_t a, size_t b) {
    return std::tuple(compare(a, b), candidates_[b].earned, a) < std::tuple(0, candidates_[a].earned, b);
  });
  const auto end =
      std::unique(tried_.begin(), tried_.end(), [&](size_t a, size_t b) { return compare(a, b) == 0; });
  tried_.erase(end, tried_.end());
}

/// Lets the network value the states.
void BeamSearch::Evaluate() {
  const auto inputs = static_cast<size_t>(experiment_.world().observation_size());
  for (size_t column = 0; column < tried_.size(); ++column) {
    experiment_.world().Observe(candidates_[tried_[column]].state,
                                {workspace_->input().col(static_cast<int64_t>(column)).data(), inputs});
  }
  if (!tried_.empty()) {
    experiment_.network()->Forward(Values(*parameters_), {0, static_cast<int>(tried_.size())}, *workspace_);
  }
  for (size_t column = 0; column < tried_.size(); ++column) {
    Node& node = candidates_[tried_[column]];
    const auto values = workspace_->output().col(static_cast<int64_t>(column));
    std::copy_n(values.data(), node.action_values.size(), node.action_values.begin());
    const int best = GreedyAction(workspace_->output(), static_cast<int>(column), node.mask);
    node.value = node.earned + double{node.action_values[static_cast<size_t>(best)]};
  }
}

/// Keeps the best of the candidates.
void BeamSearch::Keep() {
  kept_ = std::min(tried_.size(), width_);
  std::partial_sort(tried_.begin(), tried_.begin() + static_cast<int64_t>(kept_), tried_.end(),
                    [&](size_t a, size_t b) {
                      return std::tuple(-candidates_[a].value, a) < std::tuple(-candidates_[b].value, b);
                    });
  steps_.emplace_back();
  for (size_t i = 0; i < kept_; ++i) {
    std::swap(nodes_[i], candidates_[tried_[i]]);
    steps_.back().push_back(nodes_[i].origin);
  }
}

std::vector<int16_t> BeamSearch::BestActions() const {
  FRESCO_CHECK(best_step_ > 0);
  std::vector<int16_t> actions;
  Origin origin = best_origin_;
  for (size_t step = best_step_; step > 0; --step) {
    actions.push_back(origin.action);
    origin = steps_[step - 1][static_cast<size_t>(origin.parent)];
  }
  std::reverse(actions.begin(), actions.end());
  return actions;
}

Episode FlySearching(const Experiment& experiment, uint64_t seed, std::shared_ptr<const Vector> parameters,
                     int width) {
  BeamSearch search(experiment, width);
  search.Begin(seed, parameters);
  while (search.Step()) {
  }
  Episode found;
  FRESCO_CHECK(FlyActions(experiment.world(), seed, search.BestActions(), found));
  Episode greedy = FlyGreedily(experiment, seed, std::move(parameters));
  return Return(greedy) > Return(found) ? greedy : found;
}

}  // namespace fresco
