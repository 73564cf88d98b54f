// PyTorch as the peer of an update: processes of tests/bench/pytorch_update.py. Used by the main thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/child_process.h"

namespace fresco {

/// A process that makes updates by PyTorch.
class PyTorchUpdates {
 public:
  /// Starts one process for each set of kernels that PyTorch may use, and lets each find its fastest way,
  /// which it tries for `seconds` each. Empty, with the cause in `reason`, if there is no PyTorch.
  static std::vector<std::unique_ptr<PyTorchUpdates>> StartAll(double seconds, std::string& reason);

  ~PyTorchUpdates();
  PyTorchUpdates(const PyTorchUpdates&) = delete;
  PyTorchUpdates& operator=(const PyTorchUpdates&) = delete;

  /// The version and the way, for people.
  const std::string& description() const { return description_; }
  /// Makes so many updates; returns when they are done. Throws Failure if the process ended.
  void Make(int updates);

 private:
  PyTorchUpdates(const std::string& kernels, double seconds);
  /// The next line that the process writes; empty if it ended.
  std::string ReadLine();

  int requests_ = -1;  // the end of the pipe to the process
  int answers_ = -1;   // the end of the pipe from it
  std::unique_ptr<ChildProcess> process_;
  std::string description_;  // empty: it ended
};

}  // namespace fresco
