#include "soak/process_watch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/clock.h"
#include "core/files.h"

namespace fresco {
namespace {

using Path = std::filesystem::path;

Path FolderOf(pid_t pid) {
  return Path("/proc") / std::to_string(pid);
}

/// Returns -1 if they can't be read because the process has just ended.
int CountDescriptors(pid_t pid) {
  std::error_code error;
  std::filesystem::directory_iterator entry(FolderOf(pid) / "fd", error);
  int count = 0;
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    ++count;
  }
  return error ? -1 : count;
}

std::string CommandLine(pid_t pid) {
  std::ifstream stream(FolderOf(pid) / "cmdline", std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<pid_t> AllProcesses() {
  std::vector<pid_t> pids;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; })) {
      pids.push_back(static_cast<pid_t>(std::stol(name)));
    }
  }
  return pids;
}

}  // namespace

std::optional<ProcessState> ReadProcess(pid_t pid) {
  std::ifstream stream(FolderOf(pid) / "status");
  ProcessState state;
  for (std::string line; std::getline(stream, line);) {
    const size_t colon = line.find(':');
    const size_t begin = line.find_first_not_of(" \t", std::min(colon + 1, line.size()));
    const std::string name = line.substr(0, colon);
    const std::string value = begin == std::string::npos ? "" : line.substr(begin);
    if (name == "Name") {
      state.program = value;
    } else if (name == "PPid") {
      state.parent = static_cast<pid_t>(std::stol(value));
    } else if (name == "VmRSS") {
      state.use.resident_kib = std::stoll(value);
    } else if (name == "VmHWM") {
      state.use.peak_kib = std::stoll(value);
    }
  }
  state.use.descriptors = std::max(0, CountDescriptors(pid));
  return state.program.empty() ? std::nullopt : std::optional(state);
}

std::vector<std::string> ProcessesLeftBehind(const Path& folder) {
  std::vector<std::string> found;
  for (const pid_t pid : AllProcesses()) {
    const auto state = ReadProcess(pid);
    const bool child = state && state->parent == getpid();
    const bool at_work = state && state->program == "fresco-learner" &&
                         CommandLine(pid).find((folder / "").string()) != std::string::npos;
    if (child || at_work) {
      found.push_back(fmt::format("{} (process {})", state->program, pid));
    }
  }
  return found;
}

std::vector<std::string> FilesLeftBehind(const Path& folder) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (IsTemporaryOfAtomicFile(entry.path())) {
      found.push_back(entry.path().string());
    }
  }
  return found;
}

void Include(const UseByProgram& other, UseByProgram& maxima) {
  for (const auto& [program, use] : other) {
    ProcessUse& most = maxima[program];
    most.resident_kib = std::max(most.resident_kib, use.resident_kib);
    most.peak_kib = std::max(most.peak_kib, use.peak_kib);
    most.descriptors = std::max(most.descriptors, use.descriptors);
  }
}

void ProcessWatch::Look(const std::vector<pid_t>& pids) {
  constexpr int64_t kPeriodUs = 200'000;
  const int64_t now_us = MonotonicMicroseconds();
  if (now_us < next_us_) {
    return;
  }
  next_us_ = now_us + kPeriodUs;
  std::vector<pid_t> all = pids;
  all.push_back(getpid());
  for (const pid_t pid : all) {
    if (const auto state = ReadProcess(pid)) {
      Include({{state->program, state->use}}, maxima_);
    }
  }
}

}  // namespace fresco
