#include "worlds/world.h"

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

}  // namespace

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
}

void World::Judge(const Episode& episode, std::span<double> figures) const {
  FRESCO_CHECK(figures.size() == 1);
  figures[0] = Return(episode);
}

Episode World::FlyReference(const std::string&) const {
  FRESCO_CHECK(false);
}

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
