// A world from a plug-in (fresco/world.h). What it is comes from another process (the program fresco-world),
// so a library that crashes or hangs is refused like any other wrong configuration. Its code is loaded into
// this process with the first environment. So a learner, which has none, never runs it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "plugins/plugin_library.h"
#include "worlds/world.h"

namespace fresco {

/// Asks the library in another process. Remembers the answer for as long as this process runs. Throws
/// UsageError that names the library and what is wrong. Any thread may call it.
PluginDescription DescribePlugin(const PluginSpec& spec);

/// A description as JSON, and back: what fresco-world prints. PluginDescriptionFrom throws UsageError.
std::string ToJson(const PluginDescription& description);
PluginDescription PluginDescriptionFrom(const std::string& json);

class PluginWorld : public World {
 public:
  PluginWorld(PluginSpec spec, PluginDescription description);

  /// Only one thread at a time may use the environments of a process. Their functions throw as those of
  /// PluginLibrary do.
  std::unique_ptr<Environment> NewEnvironment() const override;
  /// The observation is the state.
  void Observe(std::span<const float> state, std::span<float> observation) const override;
  std::optional<StateFormulas> Formulate(Formulas& formulas) const override;
  bool Succeeded(const Episode& episode) const override;

 private:
  PluginSpec spec_;
  double success_return_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<PluginLibrary> library_;  // with the first environment
};

/// CRC-32C of a file; never 0. Throws UsageError if it can't be read. `field` is the configuration's, for
/// errors.
uint32_t CodeCrc(const std::string& path, const std::string& field);

}  // namespace fresco
