// Puts FRESCO_RUN's parts together until a run's whole configuration is here. Holds the parts of one
// run at a time, so memory is bounded. Not thread-safe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msgs/wire.h"

namespace fresco {

class RunAnnouncements {
 public:
  /// Takes a part. Returns the configuration's text once every part of one run is here.
  std::optional<std::string> Add(const run_t& message);

 private:
  RunIdentity identity_;
  std::vector<std::optional<std::string>> parts_;
};

}  // namespace fresco
