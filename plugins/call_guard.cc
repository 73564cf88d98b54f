#include "plugins/call_guard.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <mutex>
#include <thread>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

/// The call that is running. A signal handler and the watching thread read it.
struct RunningCall {
  std::atomic<const char*> library = nullptr;
  std::atomic<const char*> call = nullptr;
  std::atomic<int64_t> deadline_us = 0;  // 0: none is running
};
RunningCall running;

void Write(const char* text) {
  static_cast<void>(!write(STDERR_FILENO, text, std::strlen(text)));
}

/// Ends the process. Does nothing that a signal handler must not do.
[[noreturn]] void EndProcess(const char* what) {
  Write("error: the plug-in ");
  Write(running.library);
  Write(what);
  Write(" in ");
  Write(running.call);
  Write("()\n");
  _exit(static_cast<int>(ErrorKind::kPlugin));
}

void HandleCrash(int signal_number) {
  if (running.deadline_us == 0) {  // not the plug-in's: as without a handler
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
    return;
  }
  switch (signal_number) {
    case SIGSEGV:
      EndProcess(" crashed (segmentation fault)");
    case SIGBUS:
      EndProcess(" crashed (bus error)");
    case SIGFPE:
      EndProcess(" crashed (arithmetic exception)");
    case SIGILL:
      EndProcess(" crashed (illegal instruction)");
    default:
      EndProcess(" crashed (aborted)");
  }
}

void WatchTime() {
  constexpr auto kPeriod = std::chrono::milliseconds(50);
  for (;;) {
    std::this_thread::sleep_for(kPeriod);
    const int64_t deadline_us = running.deadline_us;
    if (deadline_us != 0 && MonotonicMicroseconds() > deadline_us) {
      EndProcess(" did not return in time");
    }
  }
}

void Prepare() {
  // A stack of its own for the handler, since a plug-in may use up the thread's.
  static std::array<char, 1 << 16> stack;
  stack_t alternate{};
  alternate.ss_sp = stack.data();
  alternate.ss_size = stack.size();
  sigaltstack(&alternate, nullptr);
  struct sigaction action {};
  action.sa_handler = HandleCrash;
  action.sa_flags = SA_ONSTACK;
  for (const int signal_number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    sigaction(signal_number, &action, nullptr);
  }
  std::thread(WatchTime).detach();
}

}  // namespace

CallGuard::CallGuard(const std::string& library, const char* call, double limit_s) {
  static std::once_flag prepared;
  std::call_once(prepared, Prepare);
  FRESCO_CHECK(running.deadline_us == 0);
  running.library = library.c_str();
  running.call = call;
  running.deadline_us = MonotonicMicroseconds() + static_cast<int64_t>(1e6 * limit_s);
}

CallGuard::~CallGuard() {
  running.deadline_us = 0;
}

}  // namespace fresco
