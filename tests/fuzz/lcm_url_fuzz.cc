// LCM URLs and channel prefixes. A normalized URL is normal already; a channel's name is one for LCM, which
// reads names as regular expressions.
#include <algorithm>
#include <cctype>

#include "bus/lcm_url.h"
#include "core/error.h"
#include "msgs/channels.h"
#include "tests/fuzz/fuzz_input.h"

namespace fresco {
namespace {

void CheckUrl(const std::string& url) {
  const std::string normal = ParseLcmUrl(url).text;
  FRESCO_CHECK(ParseLcmUrl(normal).text == normal);
}

void CheckPrefix(const std::string& prefix) {
  const Channels channels = ChannelsWithPrefix(prefix);
  constexpr size_t kLongestChannel = 63;  // LCM's own limit
  FRESCO_CHECK(channels.learner_status.size() <= kLongestChannel);
  FRESCO_CHECK(std::all_of(channels.run.begin(), channels.run.end(),
                           [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }));
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  const std::string text(TextOf(data, size));
  Accepts([&] { CheckUrl(text); });
  Accepts([&] { CheckPrefix(text); });
  return 0;
}
