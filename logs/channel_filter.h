// Selects channels by regular expressions, which must match a channel's whole name, as in LCM. Only one
// thread may use an object.
#pragma once

#include <map>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace fresco {

class ChannelFilter {
 public:
  /// Selects every channel.
  ChannelFilter() = default;
  /// Selects the channels that match one of the expressions; every channel if there are no expressions.
  /// Throws UsageError if one is not a regular expression; the error names `option`, the command line option
  /// it came from.
  ChannelFilter(const std::vector<std::string>& expressions, const std::string& option);

  bool Matches(std::string_view channel);
  bool lets_all_through() const { return expressions_.empty(); }

 private:
  std::vector<std::regex> expressions_;
  std::map<std::string, bool, std::less<>> known_;  // results for names that came before
};

}  // namespace fresco
