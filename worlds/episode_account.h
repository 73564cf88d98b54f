// How one episode is told to people and to programs, in any world: what World::Tell returns. A value; any
// thread may use it.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace fresco {

/// Nothing (such as the action in the last state), yes or no, a whole number, a number, a text, or a list of
/// whole numbers.
using AccountValue = std::variant<std::monostate, bool, int64_t, double, std::string, std::vector<int64_t>>;

/// Names have lower-case letters, digits and underscores.
struct EpisodeFact {
  std::string name;
  AccountValue value;
};

struct EpisodeAccount {
  std::string sentence;              ///< how it ended, for people: "arrived; average AoI 17.543 slots"
  std::vector<EpisodeFact> facts;    ///< about the whole episode
  std::string steps_name;            ///< of the table of steps, e.g. "flight"
  std::vector<std::string> columns;  ///< names of the columns of this table
  std::vector<std::vector<AccountValue>> steps;  ///< a row for each state of the episode, the last one too
};

}  // namespace fresco
