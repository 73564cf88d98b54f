#include "bus/open_bus.h"

#include <utility>

#include "bus/authenticated_bus.h"

namespace fresco {

std::unique_ptr<Bus> OpenBus(const std::string& url, const BusOptions& options) {
  std::optional<AuthenticationKey> key;
  if (options.key_file) {
    key = ReadAuthenticationKey(*options.key_file);  // before anything is received
  }
  std::unique_ptr<Bus> bus = OpenLcmBus(url);
  if (options.disturbance) {
    bus = MakeLossyBus(std::move(bus), *options.disturbance);
  }
  return key ? MakeAuthenticatedBus(std::move(bus), *key) : std::move(bus);
}

}  // namespace fresco
