// Guards the calls into code that is not ours. A call that crashes or does not return in time ends this
// process, with a message on standard error that names the library and the call. Any thread may make guarded
// calls; one at a time.
#pragma once

#include <string>

namespace fresco {

/// Guards the calls that are made while it lives. A process that a call ends has the exit status of
/// ErrorKind::kPlugin. `library` and `call` must outlive it. From the first one on, a
/// thread watches the time, and SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT during a call are reported.
class CallGuard {
 public:
  CallGuard(const std::string& library, const char* call, double limit_s);
  ~CallGuard();
  CallGuard(const CallGuard&) = delete;
  CallGuard& operator=(const CallGuard&) = delete;
};

}  // namespace fresco
