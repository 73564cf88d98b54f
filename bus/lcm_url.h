// LCM URLs: checked before LCM sees them, with what Fresco needs added. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fresco {

/// The URL as it is given to LCM: udpm with ttl=0 and a 4 MB receive buffer where it names none.
/// Throws UsageError naming the offending part and an example where it is not a udpm://, tcpq:// or
/// memq:// URL, or has an option that LCM would silently ignore.
std::string NormalizeLcmUrl(const std::string& url);

struct MulticastEndpoint {
  std::string group;  ///< IPv4 address
  uint16_t port = 0;
  int receive_buffer_bytes = 0;
};

/// Where a normalized URL receives; none: it is not udpm.
std::optional<MulticastEndpoint> MulticastEndpointOf(const std::string& url);

}  // namespace fresco
