#include "core/state_signal.h"

#include <csignal>

#include <atomic>

namespace fresco {
namespace {

std::atomic<bool> state_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void HandleStateSignal(int) {
  state_requested.store(true, std::memory_order_relaxed);
}

}  // namespace

void StateSignal::Install() {
  struct sigaction action = {};
  action.sa_handler = HandleStateSignal;
  action.sa_flags = SA_RESTART;  // nothing that is under way may fail by it
  sigemptyset(&action.sa_mask);
  sigaction(SIGUSR1, &action, nullptr);
}

bool StateSignal::TakeRequest() {
  return state_requested.exchange(false, std::memory_order_relaxed);
}

}  // namespace fresco
