// The signals of a program as flags to look at, so that it ends in order and says what it is doing.
#pragma once

namespace fresco {

/// SIGINT and SIGTERM. A second one while the program is ending kills it at once. Thread-safe after Install.
class StopSignal {
 public:
  /// Installs the handlers. Call it in main before any thread is started.
  static void Install();

  /// Whether the program was asked to stop.
  static bool Requested();

  /// Asks this program to stop, as a signal would. Async-signal-safe.
  static void Request();
};

/// SIGUSR1: somebody wants to know what the program is doing. Thread-safe after Install.
class StateSignal {
 public:
  /// Installs the handler. Call it in main before any thread is started.
  static void Install();

  /// Whether the program's state was asked for since the last call.
  static bool ConsumeRequest();
};

}  // namespace fresco
