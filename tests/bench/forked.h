// Processes that measurements need beside this one, and what they share. Used by the main thread.
#pragma once

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <new>
#include <vector>

#include "core/error.h"

namespace fresco {

/// Memory that this process and its later children share: `count` objects that need no destructor.
template <class Object>
class SharedObjects {
 public:
  explicit SharedObjects(size_t count)
      : bytes_(count * sizeof(Object)),
        objects_(static_cast<Object*>(
            mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    FRESCO_CHECK(objects_ != MAP_FAILED);
    for (size_t i = 0; i < count; ++i) {
      new (objects_ + i) Object();
    }
  }
  ~SharedObjects() { munmap(objects_, bytes_); }
  SharedObjects(const SharedObjects&) = delete;
  SharedObjects& operator=(const SharedObjects&) = delete;

  Object& operator[](size_t i) { return objects_[i]; }

 private:
  size_t bytes_;
  Object* objects_;
};

/// Copies of this process that do something until the object is destroyed.
class ForkedProcesses {
 public:
  /// Calls work(number) in each of `count` processes. Make it before this process opens what it must not
  /// share with them.
  ForkedProcesses(size_t count, const std::function<void(size_t)>& work) {
    for (size_t number = 0; number < count; ++number) {
      const pid_t pid = fork();
      FRESCO_CHECK(pid >= 0);
      if (pid == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        work(number);
        _exit(0);
      }
      pids_.push_back(pid);
    }
  }
  ~ForkedProcesses() {
    for (const pid_t pid : pids_) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
  }
  ForkedProcesses(const ForkedProcesses&) = delete;
  ForkedProcesses& operator=(const ForkedProcesses&) = delete;

 private:
  std::vector<pid_t> pids_;
};

}  // namespace fresco
