#include "worlds/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

/// Lower-case letters, digits and underscores.
bool IsName(const std::string& text) {
  return !text.empty() && text.size() <= kMaximumNameBytes &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

bool HasName(const Quantity& quantity) {
  return IsName(quantity.name);
}

/// Whether the sizes are those of the observation and the actions.
bool Fit(const ObservationSets& sets, const WorldDescription& description) {
  return sets.own_inputs >= 1 && sets.items >= 1 && sets.item_inputs >= 1 && sets.groups >= 1 &&
         description.observation_size == sets.own_inputs + int64_t{sets.items} * sets.item_inputs &&
         description.actions.size() ==
             static_cast<size_t>(sets.groups) * (static_cast<size_t>(sets.items) + 1);
}

}  // namespace

std::string Title(const std::string& name) {
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  if (title.ends_with("aoi")) {  // an acronym
    title.replace(title.size() - 3, 3, "AoI");
  }
  return title;
}

void Environment::WriteMask(std::span<uint8_t> mask) const {
  std::fill(mask.begin(), mask.end(), uint8_t{1});
}

World::World(WorldDescription description) : description_(std::move(description)) {
  FRESCO_CHECK(state_size() >= 1 && state_size() <= kMaximumStateSize);
  FRESCO_CHECK(actions() >= 1 && actions() <= kMaximumActions);
  FRESCO_CHECK(longest_episode() >= 1 && longest_episode() <= kMaximumEpisode);
  FRESCO_CHECK(observation_size() >= 1 && !description_.figures.empty());
  FRESCO_CHECK(description_.discount >= 0 && description_.discount <= 1);
  FRESCO_CHECK(IsName(description_.name) && IsName(description_.success));
  FRESCO_CHECK(std::all_of(description_.state.begin(), description_.state.end(), HasName));
  FRESCO_CHECK(std::all_of(description_.figures.begin(), description_.figures.end(), HasName));
  FRESCO_CHECK(description_.preferences.empty() ||
               description_.preferences.size() == description_.state.size());
  FRESCO_CHECK(!description_.sets || Fit(*description_.sets, description_));
}

std::optional<StateFormulas> World::Formulate(Formulas&) const {
  return std::nullopt;
}

void World::Judge(const Episode& episode, std::span<double> figures) const {
  FRESCO_CHECK(figures.size() == 1);
  figures[0] = Return(episode);
}

EpisodeAccount World::Tell(const Episode& episode) const {
  EpisodeAccount account;
  const bool succeeded = Succeeded(episode);
  account.sentence = (succeeded ? "" : "not ") + Title(description_.success);
  account.facts = {{description_.success, succeeded}, {"steps", int64_t{episode.transitions()}}};
  std::vector<double> figures(description_.figures.size());
  Judge(episode, figures);
  for (size_t i = 0; i < figures.size(); ++i) {
    const auto& [name, unit] = description_.figures[i];
    account.sentence += fmt::format("{} {} {:.3f}{}{}", i == 0 ? ";" : ",", Title(name), figures[i],
                                    unit.empty() ? "" : " ", unit);
    account.facts.push_back({name, figures[i]});
  }
  account.steps_name = "episode";
  account.columns = {"step"};
  for (const Quantity& field : description_.state) {
    account.columns.push_back(field.name);
  }
  account.columns.insert(account.columns.end(), {"action", "reward"});
  for (size_t i = 0; i <= episode.actions.size(); ++i) {
    std::vector<AccountValue> row = {static_cast<int64_t>(i)};
    for (const float value : episode.state(i)) {
      row.emplace_back(double{value});
    }
    if (i < episode.actions.size()) {
      row.emplace_back(description_.actions[static_cast<size_t>(episode.actions[i])]);
      row.emplace_back(double{episode.rewards[i]});
    } else {
      row.resize(account.columns.size());
    }
    account.steps.push_back(std::move(row));
  }
  return account;
}

Episode World::FlyReference(const std::string&, uint64_t) const {
  FRESCO_CHECK(false);
}

void Environment::CopyFrom(const Environment&) {
  FRESCO_CHECK(false);
}

std::string World::GroupOf(const Episode&) const {
  return "";
}

void World::CheckServes(const World&) const {}

int World::DrawPlace(RandomStream&) const {
  FRESCO_CHECK(false);
}

bool World::IsAt(std::span<const float>, int) const {
  FRESCO_CHECK(false);
}

ActionRange World::Towards(std::span<const float>, int) const {
  FRESCO_CHECK(false);
}

}  // namespace fresco
