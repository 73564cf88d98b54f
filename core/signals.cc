#include "core/signals.h"

#include <csignal>

#include <atomic>

namespace fresco {
namespace {

std::atomic<bool> stop_requested{false};
std::atomic<bool> state_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void HandleStop(int signal_number) {
  if (stop_requested.exchange(true)) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
}

void HandleStateRequest(int) {
  state_requested.store(true, std::memory_order_relaxed);
}

void InstallHandler(int signal_number, void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

void StopSignal::Install() {
  // No SA_RESTART: a program that waits in poll wakes up and sees the request.
  InstallHandler(SIGINT, HandleStop, 0);
  InstallHandler(SIGTERM, HandleStop, 0);
}

bool StopSignal::Requested() {
  return stop_requested.load(std::memory_order_relaxed);
}

void StopSignal::Request() {
  stop_requested.store(true, std::memory_order_relaxed);
}

void StateSignal::Install() {
  InstallHandler(SIGUSR1, HandleStateRequest, SA_RESTART);  // nothing that is under way may fail by it
}

bool StateSignal::ConsumeRequest() {
  return state_requested.exchange(false, std::memory_order_relaxed);
}

}  // namespace fresco
