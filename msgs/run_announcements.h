// Joins the parts of a configuration that arrive on FRESCO_RUN. Holds the parts of one run at a time, so its
// memory is bounded. An actor owns one. Not thread-safe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msgs/wire.h"

namespace fresco {

class RunAnnouncements {
 public:
  /// Adds a part. Returns the configuration's text if every part of the run has arrived, otherwise nullopt. A
  /// part of another run discards the parts of the run before. Ignores a part whose index is out of range.
  std::optional<std::string> Add(const run_t& message);

  /// The number of parts that have arrived.
  int parts() const;

 private:
  RunIdentity identity_;
  std::vector<std::optional<std::string>> parts_;
};

}  // namespace fresco
