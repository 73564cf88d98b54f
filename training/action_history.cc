#include "training/action_history.h"

#include <algorithm>

namespace fresco {

ActionHistory::ActionHistory(int64_t capacity, int longest_episode)
    : capacity_(capacity), ring_(static_cast<size_t>(capacity + longest_episode)) {}

void ActionHistory::Add(int16_t action, bool last) {
  ring_[static_cast<size_t>(added_ % static_cast<int64_t>(ring_.size()))] = {action, last};
  ++added_;
}

const ActionHistory::Entry& ActionHistory::Latest(int64_t age) const {
  return ring_[static_cast<size_t>((added_ - 1 - age) % static_cast<int64_t>(ring_.size()))];
}

std::vector<int16_t> ActionHistory::Actions() const {
  int64_t count = std::min(added_, capacity_);
  // Go back to the beginning of the episode: the transition before it ended the previous episode.
  while (count > 0 && count < added_ && !Latest(count).last) {
    ++count;
  }
  std::vector<int16_t> actions(static_cast<size_t>(count));
  for (int64_t age = 0; age < count; ++age) {
    actions[static_cast<size_t>(count - 1 - age)] = Latest(age).action;
  }
  return actions;
}

}  // namespace fresco
