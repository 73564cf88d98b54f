// Writes a run's files on a thread of its own, so that neither a slow nor a full disk delays the training.
// Each file is written completely or not at all. If a file can't be written, the writer logs it and tries
// again until it succeeds or a newer version of the file replaces it. RunFolder owns one. Any thread may call
// any function.
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
  /// `try_again_us`: the pause after a failure, microseconds.
  explicit FileWriter(int64_t try_again_us = 2'000'000);
  /// Tries once more to write every waiting file, then ends.
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  /// A file to write.
  struct File {
    std::string name;                      ///< a new file replaces one of the same name that still waits
    std::filesystem::path path;            ///< where to write it
    std::function<std::string()> content;  ///< returns its content; called on the writer's thread
    std::function<void()> written;         ///< called on the writer's thread after it was written; may be
                                           ///< empty
  };
  /// Adds a file to those that wait. Returns at once.
  void Write(File file);

  /// Whether a file of this name waits or is being written.
  bool IsBusy(const std::string& name) const;

  /// Waits until the writer has tried to write every file. Throws Failure if one can't be written.
  void Finish();

  /// Why a file that still waits could not be written; empty if there is no such file.
  std::string problem() const;

 private:
  /// A file that waits. `problem` says why the last attempt failed; empty before the first.
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
  std::string writing_;  // name of the file that is being written; empty if none is
  int64_t attempts_ = 0;
  int64_t hurry_until_ = 0;  // make no pauses until attempts_ reaches this, since somebody waits
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace fresco
