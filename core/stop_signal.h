// SIGINT and SIGTERM as a flag to look at, so that programs end in order.
#pragma once

namespace fresco {

/// Installs handlers for SIGINT and SIGTERM once per process; a second SIGINT or SIGTERM while the
/// program is ending kills it at once. Thread-safe after Install.
class StopSignal {
 public:
  /// Installs the handlers. Call it in main before any thread is started.
  static void Install();

  /// Whether the program was asked to stop.
  static bool Requested();

  /// Asks this program to stop, as a signal would. Async-signal-safe.
  static void Request();
};

}  // namespace fresco
