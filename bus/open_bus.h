// Opens the bus of a program: LCM, wrapped as the command line says. These options are not part of an
// experiment's configuration, since that is sent to everybody.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bus/authentication_key.h"
#include "bus/bus.h"
#include "bus/lossy_bus.h"

namespace fresco {

struct BusOptions {
  KeyFile key_file = {};                        ///< if set, messages are authenticated with this key
  std::optional<LossOptions> disturbance = {};  ///< if set, sent messages are disturbed; for tests and soak
                                                ///< runs
};

/// Opens the bus. Any thread may call it. Throws UsageError as OpenLcmBus does, and if the key file can't be
/// used.
std::unique_ptr<Bus> OpenBus(const std::string& url, const BusOptions& options);

}  // namespace fresco
