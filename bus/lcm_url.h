// Checks LCM URLs before LCM reads them, and adds the options that Fresco needs. Pure functions; any thread
// may call them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fresco {

/// Where a udpm URL sends and receives.
struct MulticastEndpoint {
  std::string group;  ///< IPv4 address of the multicast group
  uint16_t port = 0;
  int receive_buffer_bytes = 0;
  int ttl = 0;  ///< routers that a packet may cross, plus one; 0: it stays on this machine
};

struct LcmUrl {
  std::string text;                                 ///< in the form that LCM gets
  std::optional<MulticastEndpoint> multicast = {};  ///< set if it is a udpm URL
};

/// Reads a URL. A udpm URL gets ttl=0 and a receive buffer of 4 MB if it does not say otherwise. Throws
/// UsageError if the URL is not a valid udpm://, tcpq:// or memq:// URL, or has an option that LCM would
/// silently ignore; the error names the wrong part and gives an example.
LcmUrl ParseLcmUrl(const std::string& url);

}  // namespace fresco
