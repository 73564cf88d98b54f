#include "training/beam_search.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "training/flyer.h"

namespace fresco {
bool BeamSearch::ByEqualFields::operator()(const std::vector<float>* a, const std::vector<float>* b) const {
  for (const size_t field : search->equal_fields_) {
    const auto bits_a = std::bit_cast<uint32_t>((*a)[field]);
    const auto bits_b = std::bit_cast<uint32_t>((*b)[field]);
    if (bits_a != bits_b) {
      return bits_a < bits_b;
    }
  }
  return false;
}

BeamSearch::Node::Node(const World& world)
    : environment(world.NewEnvironment()),
      state(static_cast<size_t>(world.state_size())),
      mask(static_cast<size_t>(world.actions())) {}

BeamSearch::BeamSearch(const Experiment& experiment, int width)
    : experiment_(experiment),
      width_(static_cast<size_t>(width)),
      workspace_(experiment.network()->NewWorkspace(width, NetworkWorkspace::Passes::kForward)) {
  FRESCO_CHECK(experiment.world().description().copies && width >= 1);
  for (size_t i = 0; i < width_; ++i) {
    nodes_.emplace_back(experiment.world());
    longer_.emplace_back(experiment.world());
  }
  for (size_t field = 0; field < static_cast<size_t>(experiment.world().state_size()); ++field) {
    const bool only_equal = experiment.world().preference(field) == Preference::kOnlyEqual;
    (only_equal ? equal_fields_ : ordered_fields_).push_back(field);
  }
}

int64_t BeamSearch::BytesFor(const Experiment& experiment, int width) {
  const World& world = experiment.world();
  const size_t of_node = sizeof(Node) + static_cast<size_t>(world.state_size()) * sizeof(float) +
                         static_cast<size_t>(world.actions());
  const size_t of_choices = static_cast<size_t>(world.actions()) * sizeof(Choice);
  const size_t of_steps = static_cast<size_t>(world.longest_episode()) * sizeof(Origin);
  return experiment.network()->WorkspaceBytes(width, NetworkWorkspace::Passes::kForward) +
         width * static_cast<int64_t>(2 * of_node + of_choices + of_steps);
}

void BeamSearch::Begin(uint64_t seed, std::shared_ptr<const Vector> parameters,
                       std::span<const int16_t> first) {
  first_.assign(first.begin(), first.end());
  parameters_ = std::move(parameters);
  steps_.clear();
  best_return_ = -std::numeric_limits<double>::infinity();
  best_step_ = 0;
  Node& root = nodes_.front();
  root.environment->Reset(seed);
  for (const int16_t action : first) {
    root.environment->Step(action);
  }
  root.environment->WriteState(root.state);
  root.environment->WriteMask(root.mask);
  root.origin = {};
  root.earned = 0;
  count_ = 1;
}

bool BeamSearch::Step() {
  Evaluate();
  Choose();
  steps_.emplace_back();
  for (size_t i = 0; i < count_; ++i) {
    steps_.back().push_back(nodes_[i].origin);
  }
  size_t count = 0;
  std::map<const std::vector<float>*, std::vector<size_t>, ByEqualFields> comparable(ByEqualFields{this});
  for (size_t i = 0; i < choices_.size() && count < width_; ++i) {
    Node& node = longer_[count];
    if (!Try(choices_[i].origin, node)) {
      continue;
    }
    const auto found = comparable.find(&node.state);
    if (found == comparable.end()) {
      comparable[&node.state] = {count};
      ++count;
      continue;
    }
    std::vector<size_t>& others = found->second;
    const auto related = std::find_if(others.begin(), others.end(), [&](size_t other) {
      return IsAsGoodAs(longer_[other], node) || IsAsGoodAs(node, longer_[other]);
    });
    if (related == others.end()) {
      others.push_back(count);
      ++count;
    } else if (!IsAsGoodAs(longer_[*related], node)) {
      std::swap(longer_[*related], node);
    }
  }
  std::swap(nodes_, longer_);
  count_ = count;
  return count_ > 0;
}

/// Lets the network value the actions of every node.
void BeamSearch::Evaluate() {
  const auto inputs = static_cast<size_t>(experiment_.world().observation_size());
  for (size_t i = 0; i < count_; ++i) {
    experiment_.world().Observe(nodes_[i].state,
                                {workspace_->input().col(static_cast<int64_t>(i)).data(), inputs});
  }
  experiment_.network()->Forward(Values(*parameters_), {0, static_cast<int>(count_)}, *workspace_);
}

/// Lists the allowed actions of all nodes, the most promising ones first.
void BeamSearch::Choose() {
  choices_.clear();
  for (size_t i = 0; i < count_; ++i) {
    const float* values = workspace_->output().col(static_cast<int64_t>(i)).data();
    for (size_t action = 0; action < nodes_[i].mask.size(); ++action) {
      if (nodes_[i].mask[action] != 0) {
        choices_.push_back({nodes_[i].earned + double{values[action]},
                            {static_cast<int32_t>(i), static_cast<int16_t>(action)}});
      }
    }
  }
  std::sort(choices_.begin(), choices_.end(), [](const Choice& a, const Choice& b) {
    return std::tuple(-a.value, a.origin.parent, a.origin.action) <
           std::tuple(-b.value, b.origin.parent, b.origin.action);
  });
}

/// Takes an action. Returns false if the episode ends with it; the best one that ends is remembered.
bool BeamSearch::Try(const Origin& origin, Node& node) {
  const Node& parent = nodes_[static_cast<size_t>(origin.parent)];
  node.environment->CopyFrom(*parent.environment);
  const StepResult result = node.environment->Step(origin.action);
  node.earned = parent.earned + result.reward;
  node.origin = origin;
  if (result.ending == Ending::kNone) {
    node.environment->WriteState(node.state);
    node.environment->WriteMask(node.mask);
    return true;
  }
  if (node.earned > best_return_) {
    best_return_ = node.earned;
    best_step_ = steps_.size();
    best_origin_ = origin;
  }
  return false;
}

/// Whether the search can do without `other`; both have the same equal_fields_.
bool BeamSearch::IsAsGoodAs(const Node& node, const Node& other) const {
  return node.earned >= other.earned &&
         std::all_of(ordered_fields_.begin(), ordered_fields_.end(), [&](size_t field) {
           return experiment_.world().preference(field) == Preference::kLess
                      ? node.state[field] <= other.state[field]
                      : node.state[field] >= other.state[field];
         });
}

std::vector<int16_t> BeamSearch::BestActions() const {
  FRESCO_CHECK(best_step_ > 0);
  std::vector<int16_t> actions;
  Origin origin = best_origin_;
  for (size_t step = best_step_; step > 0; --step) {
    actions.push_back(origin.action);
    origin = steps_[step - 1][static_cast<size_t>(origin.parent)];
  }
  actions.insert(actions.end(), first_.rbegin(), first_.rend());
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
