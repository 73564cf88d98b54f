// The bus of a program: LCM, and what the command line puts around it. None of this is part of an
// experiment's configuration, which is broadcast.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bus/authentication_key.h"
#include "bus/bus.h"
#include "bus/lossy_bus.h"

namespace fresco {

struct BusOptions {
  KeyFile key_file = {};                        ///< messages are authenticated with its key
  std::optional<LossOptions> disturbance = {};  ///< of what is sent; for tests and soak runs
};

/// Throws UsageError as OpenLcmBus does, and where the key file can't be used.
std::unique_ptr<Bus> OpenBus(const std::string& url, const BusOptions& options);

}  // namespace fresco
