// A world in words, as FRESCO_WORLD carries it. Pure functions; any thread may call them. One thread at a
// time may use an object.
#pragma once

#include <optional>
#include <vector>

#include "msgs/wire.h"
#include "worlds/world.h"

namespace fresco {

/// Returns as many messages as the names need. The caller fills in `utime`, `run_id` and `config_hash`.
std::vector<world_t> WorldMessages(const World& world);

/// What WorldMessages said of a world.
struct WorldNames {
  std::string world;
  std::vector<Quantity> state;
  std::vector<std::string> actions;
  std::vector<Quantity> figures;
  bool less_is_better = false;
  std::string success;
};

/// Joins the messages of one world, in any order.
class WorldNamesReader {
 public:
  /// Takes a message. Ignores one that does not fit the others or has absurd numbers.
  void Add(const world_t& message);
  /// The names, once every message has arrived; otherwise null.
  const WorldNames* names() const { return names_ ? &*names_ : nullptr; }

 private:
  world_t first_{};
  std::vector<std::optional<Quantity>> entries_;
  size_t missing_ = 0;
  std::optional<WorldNames> names_;
};

}  // namespace fresco
