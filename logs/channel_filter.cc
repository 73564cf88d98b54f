#include "logs/channel_filter.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace fresco {

ChannelFilter::ChannelFilter(const std::vector<std::string>& expressions, const std::string& option) {
  for (const std::string& expression : expressions) {
    try {
      expressions_.emplace_back(expression, std::regex::ECMAScript | std::regex::optimize);
    } catch (const std::regex_error& error) {
      throw UsageError(
          fmt::format("{}: expected a regular expression that matches channels' whole names, e.g. FRESCO_.*; "
                      "found \"{}\" ({})",
                      option, expression, error.what()));
    }
  }
}

bool ChannelFilter::Matches(std::string_view channel) {
  constexpr size_t kMaximumKnown = 4096;  // a limit, since anybody may send names
  if (lets_all_through()) {
    return true;
  }
  if (const auto known = known_.find(channel); known != known_.end()) {
    return known->second;
  }
  const bool matches =
      std::any_of(expressions_.begin(), expressions_.end(), [&](const std::regex& expression) {
        return std::regex_match(channel.begin(), channel.end(), expression);
      });
  if (known_.size() < kMaximumKnown) {
    known_.emplace(channel, matches);
  }
  return matches;
}

}  // namespace fresco
