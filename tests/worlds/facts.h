// Matches a fact of an episode's account, for tests.
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "worlds/episode_account.h"

namespace fresco {

/// A fact with this name and exactly this value, of this type.
inline auto IsFact(const std::string& name, const AccountValue& value) {
  return testing::AllOf(testing::Field(&EpisodeFact::name, name), testing::Field(&EpisodeFact::value, value));
}

}  // namespace fresco
