// A loaded plug-in (fresco/world.h) and its world: calls its functions, guarded (CallGuard), and checks what
// they give. Only one thread at a time may use the objects of this file.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "plugins/fresco/world.h"
#include "worlds/world.h"

namespace fresco {

/// Which world of which library.
struct PluginSpec {
  std::string library;       ///< path of the shared library
  std::string settings;      ///< for the library
  double call_limit_s = 10;  ///< that a call may take
};

/// A description, and when an episode succeeds.
struct PluginDescription {
  WorldDescription world;
  double success_return = 0;
};

class PluginLibrary {
 public:
  /// Loads the library and makes its world. Throws UsageError, which names the library and what is wrong: it
  /// can't be loaded, is no plug-in, is of another ABI version, refuses the settings, or describes a world
  /// that is not allowed.
  explicit PluginLibrary(const PluginSpec& spec);
  PluginLibrary(const PluginLibrary&) = delete;
  PluginLibrary& operator=(const PluginLibrary&) = delete;

  const PluginDescription& description() const { return description_; }

  /// An environment; this object must outlive it. Its functions throw Failure, which names the library and
  /// the call, if the plug-in fails.
  std::unique_ptr<Environment> NewEnvironment();

 private:
  void Load();
  void Describe();
  [[noreturn]] void Refuse(const std::string& problem) const;

  PluginSpec spec_;
  void* handle_ = nullptr;
  const fresco_world_functions* functions_ = nullptr;
  std::unique_ptr<void, std::function<void(void*)>> world_;  // freed by the plug-in
  PluginDescription description_;
};

}  // namespace fresco
