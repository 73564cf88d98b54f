// Threads that share the parts of one job after the other. A job may be as short as some microseconds:
// between two jobs the threads look for the next one for a while before they sleep.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <vector>

namespace fresco {

/// The processors that this process may use; at least 1.
int ProcessorCount();

class ThreadTeam {
 public:
  /// `threads` (>= 1) with the one that calls Run.
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  /// Calls work(part) for each part from 0 to before `parts` (at most kMaximumParts), on any thread and in
  /// any order, and returns when all are done. `work` must not throw. Only one thread may call it.
  template <class Work>
  void Run(int parts, Work&& work) {
    RunParts(parts, &Call<std::remove_reference_t<Work>>, &work);
  }

  static constexpr int kMaximumParts = 1'000'000;

 private:
  using Function = void (*)(void* work, int part, int thread);

  template <class Work>
  static void Call(void* work, int part, int thread) {
    (*static_cast<Work*>(work))(part, thread);
  }
  void RunParts(int parts, Function function, void* work);
  bool DoNextPart(int thread);
  void Help(int thread);

  // The job, its parts and the next part in one number, so that whoever takes a part knows that it is one.
  std::atomic<uint64_t> state_{0};
  std::atomic<int> done_{0};
  std::atomic<bool> ends_{false};
  // Written while no part can be taken.
  Function function_ = nullptr;
  void* work_ = nullptr;
  std::vector<std::thread> helpers_;
};

}  // namespace fresco
