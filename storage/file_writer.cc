#include "storage/file_writer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "core/error.h"
#include "core/files.h"

namespace fresco {

FileWriter::FileWriter(int64_t try_again_us) : try_again_us_(try_again_us), thread_([this] { Work(); }) {}

FileWriter::~FileWriter() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool FileWriter::Waits(const std::string& name) const {
  return std::any_of(waiting_.begin(), waiting_.end(), [&](const Job& job) { return job.file.name == name; });
}

bool FileWriter::HasFreshJob() const {
  return std::any_of(waiting_.begin(), waiting_.end(), [](const Job& job) { return job.problem.empty(); });
}

void FileWriter::Write(File file) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [&](const Job& job) { return job.file.name == file.name; });
  waiting_.push_back({std::move(file), ""});
  changed_.notify_all();
}

bool FileWriter::IsBusy(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return writing_ == name || Waits(name);
}

void FileWriter::Finish() {
  std::unique_lock lock(mutex_);
  hurry_until_ = attempts_ + static_cast<int64_t>(waiting_.size()) + (writing_.empty() ? 0 : 1);
  changed_.notify_all();
  changed_.wait(lock, [&] { return writing_.empty() && (attempts_ >= hurry_until_ || waiting_.empty()); });
  if (!waiting_.empty()) {
    throw Failure(waiting_.front().problem);
  }
}

std::string FileWriter::problem() const {
  const std::lock_guard lock(mutex_);
  for (const Job& job : waiting_) {
    if (!job.problem.empty()) {
      return job.problem;
    }
  }
  return "";
}

void FileWriter::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
    const auto next = NextJob(lock);
    if (next == waiting_.end()) {
      return;
    }
    Job job = std::move(*next);
    waiting_.erase(next);
    WriteOne(std::move(job), lock);
  }
}

/// Returns the first file that was not tried yet; if there is none, pauses and returns the file that was
/// tried longest ago. Returns the end if the writer ends.
std::deque<FileWriter::Job>::iterator FileWriter::NextJob(std::unique_lock<std::mutex>& lock) {
  changed_.wait_for(lock, std::chrono::microseconds(try_again_us_),
                    [&] { return ending_ || attempts_ < hurry_until_ || HasFreshJob(); });
  const auto fresh =
      std::find_if(waiting_.begin(), waiting_.end(), [](const Job& job) { return job.problem.empty(); });
  return fresh != waiting_.end() || ending_ ? fresh : waiting_.begin();
}

void FileWriter::WriteOne(Job job, std::unique_lock<std::mutex>& lock) {
  writing_ = job.file.name;
  lock.unlock();
  std::string problem;
  try {
    WriteFileAtomically(job.file.path, job.file.content());
    if (job.file.written) {
      job.file.written();
    }
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (!problem.empty() && problem != job.problem) {
    spdlog::warn("{}; will try again", problem);
  } else if (problem.empty() && !job.problem.empty()) {
    spdlog::info("{} is written now", job.file.path.string());
  }
  lock.lock();
  if (!problem.empty() && !Waits(job.file.name)) {
    job.problem = std::move(problem);
    waiting_.push_back(std::move(job));
  }
  writing_.clear();
  ++attempts_;
  changed_.notify_all();
}

}  // namespace fresco
