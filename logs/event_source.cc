#include "logs/event_source.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <string_view>

#include "bus/bus.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/signals.h"
#include "logs/bus_losses.h"

namespace fresco {
namespace {

class EventLogs : public EventSource {
 public:
  explicit EventLogs(const std::vector<std::string>& paths) : logs_({paths.begin(), paths.end()}) {}

  std::optional<LcmEvent> Next() override { return StopSignal::Requested() ? std::nullopt : logs_.Next(); }
  MergedEventLogs::Totals totals() const override { return logs_.totals(); }

  void WarnOfLosses() const override {
    const MergedEventLogs::Totals totals = logs_.totals();
    if (totals.damaged_bytes > 0) {
      spdlog::warn("damaged: {} bytes of the log were skipped", totals.damaged_bytes);
    }
    if (totals.torn_bytes > 0) {
      spdlog::warn("cut short: the last event, {} bytes, is incomplete; all events before it were read",
                   totals.torn_bytes);
    }
  }

 private:
  MergedEventLogs logs_;
};

class BusSource : public EventSource {
 public:
  BusSource(const std::string& url, double seconds) : bus_(OpenLcmBus(url)) {
    if (seconds > 0) {
      end_us_ = MonotonicMicroseconds() + static_cast<int64_t>(1e6 * seconds);
    }
    bus_->SubscribeToAll([this](const LcmEvent& event) { Take(event); });
  }

  std::optional<LcmEvent> Next() override {
    constexpr int64_t kPollUs = 100'000;
    taken_ = false;
    while (!taken_ && !StopSignal::Requested()) {
      const int64_t left_us = end_us_ - MonotonicMicroseconds();
      if (left_us <= 0) {
        return std::nullopt;
      }
      bus_->Poll(std::min(kPollUs, left_us), 1);
    }
    return taken_ ? std::optional(event_) : std::nullopt;
  }

  MergedEventLogs::Totals totals() const override { return {bytes_, 0, 0}; }
  void WarnOfLosses() const override { WarnOfBusLosses(*bus_); }

 private:
  /// Copies the event, since it is valid during the call only.
  void Take(const LcmEvent& event) {
    channel_.assign(event.channel);
    message_.assign(event.message.begin(), event.message.end());
    event_ = {event.number, event.utime, channel_, message_};
    bytes_ += static_cast<int64_t>(channel_.size() + message_.size());
    taken_ = true;
  }

  std::unique_ptr<Bus> bus_;
  int64_t end_us_ = std::numeric_limits<int64_t>::max();
  std::string channel_;
  std::vector<std::byte> message_;
  LcmEvent event_;
  int64_t bytes_ = 0;
  bool taken_ = false;
};

}  // namespace

bool IsLcmUrl(const std::string& source) {
  return source.find("://") != std::string::npos;
}

std::unique_ptr<EventSource> OpenEvents(const std::vector<std::string>& sources, double seconds) {
  if (std::none_of(sources.begin(), sources.end(), IsLcmUrl)) {
    return std::make_unique<EventLogs>(sources);
  }
  if (sources.size() > 1) {
    throw UsageError("expected event logs, or one LCM URL alone; found " + sources[0] + " beside " +
                     sources[1]);
  }
  return std::make_unique<BusSource>(sources.front(), seconds);
}

}  // namespace fresco
