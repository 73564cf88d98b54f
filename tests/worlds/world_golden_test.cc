// A whole episode of each world as text: tests/worlds/golden has a file each. golden_text.h says how to write
// them anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "tests/worlds/golden_text.h"
#include "tests/worlds/play.h"
#include "worlds/acrobot/acrobot.h"
#include "worlds/cartpole/cartpole.h"

namespace fresco {
namespace {

std::string Heading(const Quantity& quantity) {
  return quantity.unit.empty() ? quantity.name : quantity.name + " (" + quantity.unit + ")";
}

/// A line for each state, with the action that is taken in it and its reward; then how the episode ended and
/// how the world judges it.
std::string EpisodeAsText(const World& world, uint64_t seed, const Episode& episode) {
  constexpr int kNarrowest = 10;
  constexpr int kActionWidth = 14;
  const WorldDescription& description = world.description();
  std::ostringstream text;
  text << std::fixed << std::setprecision(6);
  text << "world " << description.name << ", seed " << seed << ", at most " << world.longest_episode()
       << " steps\nstep";
  std::vector<int> widths;
  for (const Quantity& field : description.state) {
    const std::string heading = Heading(field);
    widths.push_back(2 + std::max(kNarrowest, static_cast<int>(heading.size())));
    text << std::setw(widths.back()) << heading;
  }
  text << "  " << std::left << std::setw(kActionWidth) << "action" << std::right << "     reward\n";
  for (size_t step = 0; step <= episode.actions.size(); ++step) {
    text << std::setw(4) << step;
    for (size_t field = 0; field < widths.size(); ++field) {
      text << std::setw(widths[field]) << episode.state(step)[field];
    }
    if (step < episode.actions.size()) {
      const auto action = static_cast<size_t>(episode.actions[step]);
      text << "  " << std::left << std::setw(kActionWidth) << description.actions[action] << std::right
           << std::setw(11) << episode.rewards[step];
    }
    text << "\n";
  }
  text << (episode.ending == Ending::kTerminal ? "terminal" : "truncated");
  std::vector<double> figures(description.figures.size());
  world.Judge(episode, figures);
  for (size_t figure = 0; figure < figures.size(); ++figure) {
    text << ", " << Heading(description.figures[figure]) << " " << figures[figure];
  }
  text << ", " << (world.Succeeded(episode) ? "" : "not ") << description.success << "\n";
  return text.str();
}

void ExpectGoldenEpisode(const std::string& name, const World& world, uint64_t seed, const Rule& rule) {
  ExpectGoldenText(name, EpisodeAsText(world, seed, Play(world, seed, rule)));
}

TEST(GoldenWorlds, CartPoleOfRandomPushesFalls) {
  ExpectGoldenEpisode("cartpole", CartPole(500), 1, RandomActions(1, 2));
}

TEST(GoldenWorlds, AcrobotSwingsUp) {
  // The torque turns the second link against the swing of the first.
  ExpectGoldenEpisode("acrobot", Acrobot(500), 1,
                      [](std::span<const float> state) { return state[2] > 0 ? 0 : 2; });
}

}  // namespace
}  // namespace fresco
