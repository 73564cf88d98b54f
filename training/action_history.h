// Remembers the actions of the latest transitions. A checkpoint stores these instead of the replay memory:
// the world is deterministic, so everything else follows from the actions. The trainer owns it. Not
// thread-safe. Only the constructor and Actions allocate.
#pragma once

#include <cstdint>
#include <vector>

namespace fresco {

class ActionHistory {
 public:
  /// `capacity` (>= 1): transitions in the replay memory. `longest_episode` (>= 1): the most transitions that
  /// an episode can have.
  ActionHistory(int64_t capacity, int longest_episode);

  /// The memory of an object, bytes.
  static int64_t BytesFor(int64_t capacity, int longest_episode) {
    return (capacity + longest_episode) * static_cast<int64_t>(sizeof(Entry));
  }

  /// Adds the action of the next transition; `last` says whether it ends its episode.
  void Add(int16_t action, bool last);

  /// Returns the actions of whole episodes, oldest first, so that they contain the latest `capacity`
  /// transitions (or all, if there were fewer). The first episode may begin before these. The transition
  /// added last must have ended its episode.
  std::vector<int16_t> Actions() const;

 private:
  struct Entry {
    int16_t action = 0;
    bool last = false;
  };
  const Entry& Latest(int64_t age) const;  // age 0 is the latest, age 1 the one before it

  int64_t capacity_;
  std::vector<Entry> ring_;
  int64_t added_ = 0;
};

}  // namespace fresco
