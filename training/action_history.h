// The actions of the latest transitions: what a checkpoint keeps of the replay memory, the world being
// deterministic. Not thread-safe. No allocation after construction but by Actions.
#pragma once

#include <cstdint>
#include <vector>

namespace fresco {

class ActionHistory {
 public:
  /// For a replay memory of `capacity` transitions and episodes of at most `longest_episode`.
  ActionHistory(int64_t capacity, int longest_episode);

  /// What it takes of memory beside the object itself.
  static int64_t BytesFor(int64_t capacity, int longest_episode) {
    return (capacity + longest_episode) * static_cast<int64_t>(sizeof(Entry));
  }

  /// Notes a transition's action; `last`: it ends its episode.
  void Add(int16_t action, bool last);

  /// Whole episodes, oldest first, from the one that the `capacity`-th latest transition belongs to (or
  /// from the first of all). The latest transition must be an episode's last.
  std::vector<int16_t> Actions() const;

 private:
  struct Entry {
    int16_t action = 0;
    bool last = false;
  };
  const Entry& Latest(int64_t age) const;  // 0: the latest

  int64_t capacity_;
  std::vector<Entry> ring_;
  int64_t added_ = 0;
};

}  // namespace fresco
