// SIGUSR1 as a flag to look at: somebody wants to know what the program is doing.
#pragma once

namespace fresco {

/// Installs a handler for SIGUSR1 once per process. Thread-safe after Install.
class StateSignal {
 public:
  /// Installs the handler. Call it in main before any thread is started.
  static void Install();

  /// Whether the program's state was asked for since the last call.
  static bool TakeRequest();
};

}  // namespace fresco
