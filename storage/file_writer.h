// Writes a run's files on a thread of its own, each whole or not at all, so that neither a slow nor a
// full disk holds the training up. What can't be written is said in the log and tried again until it
// can, or until a newer content takes its place. All functions may be called from any thread.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace fresco {

class FileWriter {
 public:
  /// `try_again_us`: the pause after a failure.
  explicit FileWriter(int64_t try_again_us = 2'000'000);
  /// Writes what it can and ends.
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// A file to be written. `content` and then, once it is written, `written` are called on the writer's
  /// thread. A file of the same `name` that still waits is replaced.
  struct File {
    std::string name;
    std::filesystem::path path;
    std::function<std::string()> content;
    std::function<void()> written;
  };
  void Write(File file);

  /// Whether a file of this name waits or is being written.
  bool IsBusy(const std::string& name) const;

  /// Waits until every file was written or tried. Throws Failure where one can't be written.
  void Finish();

  /// Why a file that waits could not be written; empty where there is none such.
  std::string problem() const;

 private:
  /// A file that waits; `problem`: why it could not be written when it was tried.
  struct Job {
    File file;
    std::string problem;
  };

  void Work();
  std::deque<Job>::iterator NextJob(std::unique_lock<std::mutex>& lock);
  void WriteOne(Job job, std::unique_lock<std::mutex>& lock);
  bool Waits(const std::string& name) const;
  bool HasFreshJob() const;

  const int64_t try_again_us_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> waiting_;
  std::string writing_;  // name of the file that is being written; empty: none
  int64_t attempts_ = 0;
  int64_t hurry_until_ = 0;  // no pause before so many attempts: somebody waits for them
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace fresco
