#include "logs/recorder.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/clock.h"

namespace fresco {
namespace {

constexpr auto kPause = std::chrono::milliseconds(50);
constexpr size_t kHurryBytes = 4 << 20;
constexpr int64_t kFlushPeriodUs = 500'000;

}  // namespace

Recorder::Recorder(Bus& bus, RecorderOptions options)
    : bus_(bus), options_(std::move(options)), writer_(options_.path, options_.split_bytes) {
  bus_.SubscribeToAll([this](const LcmEvent& event) { Add(event); });
  thread_ = std::thread([this] { WriteBatches(); });
}

Recorder::~Recorder() {
  EndThread();
}

void Recorder::Step(int64_t timeout_us) {
  bus_.Poll(timeout_us);
  ThrowProblem();
}

Recorder::Totals Recorder::Finish() {
  // Events that were sent before may still be on their way. Wait for them, but not for ever: others may keep
  // sending.
  constexpr int64_t kQuietUs = 100'000;
  constexpr int64_t kPatienceUs = 1'000'000;
  const int64_t deadline_us = MonotonicMicroseconds() + kPatienceUs;
  while (bus_.Poll(kQuietUs) > 0 && MonotonicMicroseconds() < deadline_us) {
  }
  EndThread();
  ThrowProblem();
  totals_.files = writer_.files();
  return totals_;
}

void Recorder::Add(const LcmEvent& event) {
  if (!options_.channels.Matches(event.channel)) {
    return;
  }
  const size_t bytes = event.channel.size() + event.message.size();
  const std::lock_guard lock(mutex_);
  // The writing thread may hold the other half of the memory.
  if (waiting_.memory_bytes() + bytes + sizeof(Entry) > options_.memory_bytes / 2) {
    ++totals_.dropped_events;
    return;
  }
  ++totals_.events;
  totals_.bytes += EventLogWriter::EventBytes(event);
  waiting_.entries.push_back({event.utime, static_cast<uint32_t>(event.channel.size()),
                              static_cast<uint32_t>(event.message.size())});
  const auto channel = std::as_bytes(std::span(event.channel));
  waiting_.bytes.insert(waiting_.bytes.end(), channel.begin(), channel.end());
  waiting_.bytes.insert(waiting_.bytes.end(), event.message.begin(), event.message.end());
  if (waiting_.bytes.size() > kHurryBytes) {
    changed_.notify_all();
  }
}

void Recorder::WriteBatches() {
  try {
    while (WaitForBatch()) {
      WriteBatch();
    }
    writer_.Flush();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    problem_ = std::current_exception();
  }
}

/// Waits a little, so that events come in batches, and moves the waiting ones to writing_. Returns false if
/// the recorder ends and there are none.
bool Recorder::WaitForBatch() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kPause, [this] { return ending_ || waiting_.bytes.size() > kHurryBytes; });
  writing_.entries.clear();
  writing_.bytes.clear();
  std::swap(writing_, waiting_);
  return !ending_ || !writing_.entries.empty();
}

void Recorder::WriteBatch() {
  std::span<const std::byte> bytes = writing_.bytes;
  for (const Entry& entry : writing_.entries) {
    const auto* channel = reinterpret_cast<const char*>(bytes.data());
    writer_.Write({0,
                   entry.utime,
                   {channel, entry.channel_bytes},
                   bytes.subspan(entry.channel_bytes, entry.message_bytes)});
    bytes = bytes.subspan(entry.channel_bytes + entry.message_bytes);
  }
  if (MonotonicMicroseconds() >= flush_at_us_) {
    writer_.Flush();
    flush_at_us_ = MonotonicMicroseconds() + kFlushPeriodUs;
  }
}

void Recorder::EndThread() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void Recorder::ThrowProblem() {
  const std::lock_guard lock(mutex_);
  if (problem_) {
    std::rethrow_exception(problem_);
  }
}

}  // namespace fresco
