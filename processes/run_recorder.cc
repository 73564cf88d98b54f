#include "processes/run_recorder.h"

#include <fmt/format.h>
#include <poll.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "core/clock.h"
#include "core/error.h"
#include "core/files.h"
#include "core/installation.h"

namespace fresco {
namespace {

std::filesystem::path EventLogPath(const std::filesystem::path& folder, int number) {
  return folder / (number == 1 ? "traffic.lcm" : fmt::format("traffic-{}.lcm", number));
}

/// Returns the files of one recording: the log itself, or its parts.
std::vector<std::filesystem::path> FilesOf(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::exists(path)) {
    files.push_back(path);
  }
  for (int part = 0;; ++part) {
    std::filesystem::path file = path;
    file += fmt::format(".{:02}", part);
    if (!std::filesystem::exists(file)) {
      return files;
    }
    files.push_back(file);
  }
}

/// Returns the event logs in a run's folder, in the order in which they were recorded.
std::vector<std::filesystem::path> RecordedLogs(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> logs;
  for (int number = 1;; ++number) {
    const auto files = FilesOf(EventLogPath(folder, number));
    if (files.empty()) {
      return logs;
    }
    logs.insert(logs.end(), files.begin(), files.end());
  }
}

std::filesystem::path FreeEventLogPath(const std::filesystem::path& folder) {
  int number = 1;
  while (!FilesOf(EventLogPath(folder, number)).empty()) {
    ++number;
  }
  return EventLogPath(folder, number);
}

std::vector<std::string> RecorderArguments(const std::filesystem::path& path, const std::string& lcm_url,
                                           double split_mb) {
  std::vector<std::string> arguments = {
      SiblingProgram("fresco").string(), "log", "record", "--lcm-url", lcm_url, "--out", path.string()};
  if (split_mb > 0) {
    arguments.insert(arguments.end(), {"--split-mb", fmt::format("{}", split_mb)});
  }
  return arguments;
}

}  // namespace

RunRecorder::RunRecorder(const std::filesystem::path& folder, const std::string& lcm_url, double split_mb)
    : folder_(folder), log_(folder / "recorder.log") {
  const uintmax_t log_bytes_before = std::filesystem::exists(log_) ? std::filesystem::file_size(log_) : 0;
  process_ =
      std::make_unique<ChildProcess>(RecorderArguments(FreeEventLogPath(folder), lcm_url, split_mb), log_);
  WaitUntilItRecords(log_bytes_before);
}

RunRecorder::~RunRecorder() {
  End();
}

void RunRecorder::WaitUntilItRecords(uintmax_t log_bytes_before) {
  constexpr int64_t kPatienceUs = 30'000'000;  // LCM's self test alone takes 10 s if it fails
  constexpr int kWaitMs = 2;
  const int64_t deadline_us = MonotonicMicroseconds() + kPatienceUs;
  while (ReadFile(log_).find("recording ", log_bytes_before) == std::string::npos) {
    if (const auto status = process_->ExitStatus()) {
      throw Error(*status == static_cast<int>(ErrorKind::kUsage) ? ErrorKind::kUsage : ErrorKind::kFailure,
                  "the run can't be recorded; " + log_.string() + " ends with:" + LastLines(log_, 3));
    }
    if (MonotonicMicroseconds() > deadline_us) {
      throw Failure(fmt::format("the run can't be recorded: the recorder was not ready after {} s; see {}",
                                kPatienceUs / 1'000'000, log_.string()));
    }
    poll(nullptr, 0, kWaitMs);
  }
}

void RunRecorder::Step() {
  if (!has_failed_ && process_->ExitStatus()) {
    has_failed_ = true;
    spdlog::error("the recorder ended with status {}; the training continues without it; {} ends with:{}",
                  *process_->ExitStatus(), log_.string(), LastLines(log_, 2));
  }
}

void RunRecorder::End() {
  constexpr int64_t kPatienceUs = 60'000'000;  // for a slow disk
  if (!process_->ExitStatus()) {
    has_failed_ = process_->End(kPatienceUs) != 0;
  }
}

std::string RunRecorder::Report() const {
  std::string last = LastLines(log_, 1);
  last.erase(0, last.find_first_not_of("\n "));
  std::string logs;
  for (const auto& path : RecordedLogs(folder_)) {
    logs += fmt::format(" {}", path.string());
  }
  if (has_failed_) {
    return fmt::format("the recording is INCOMPLETE ({}); inspect it: {} log info{}", last, ProgramName(),
                       logs);
  }
  return fmt::format("{}; retrain: {} retrain{} --config {}", last, ProgramName(), logs,
                     (folder_ / "config.textproto").string());
}

}  // namespace fresco
