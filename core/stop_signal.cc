#include "core/stop_signal.h"

#include <csignal>

#include <atomic>

namespace fresco {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void HandleStopSignal(int signal_number) {
  if (stop_requested.exchange(true)) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
}

}  // namespace

void StopSignal::Install() {
  struct sigaction action = {};
  action.sa_handler = HandleStopSignal;
  sigemptyset(&action.sa_mask);
  // No SA_RESTART: a program that waits in poll wakes up and sees the request.
  for (const int signal_number : {SIGINT, SIGTERM}) {
    sigaction(signal_number, &action, nullptr);
  }
}

bool StopSignal::Requested() {
  return stop_requested.load(std::memory_order_relaxed);
}

void StopSignal::Request() {
  stop_requested.store(true, std::memory_order_relaxed);
}

}  // namespace fresco
