#include "msgs/message_decoder.h"

#include "bus/authenticated_bus.h"

namespace fresco {

std::span<const std::byte> WithoutAuthentication(std::span<const std::byte> bytes) {
  return CarriesAuthentication(bytes) ? bytes.first(bytes.size() - kAuthenticationTagBytes) : bytes;
}

}  // namespace fresco
