// Which channels somebody wants, as regular expressions that have to match a channel's whole name, as LCM
// reads them. An object belongs to one thread.
#pragma once

#include <map>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace fresco {

class ChannelFilter {
 public:
  /// Lets every channel through.
  ChannelFilter() = default;
  /// Lets those through that match one of the expressions; all, where there is none. `option` names the
  /// origin in the UsageError for what is no regular expression.
  ChannelFilter(const std::vector<std::string>& expressions, const std::string& option);

  bool Matches(std::string_view channel);
  bool lets_all_through() const { return expressions_.empty(); }

 private:
  std::vector<std::regex> expressions_;
  std::map<std::string, bool, std::less<>> known_;
};

}  // namespace fresco
