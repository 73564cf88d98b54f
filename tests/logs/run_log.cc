#include "tests/logs/run_log.h"

#include <algorithm>

#include "core/bytes.h"
#include "logs/event_log_writer.h"
#include "msgs/weights_codec.h"
#include "msgs/world_messages.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

class Events {
 public:
  explicit Events(RunIdentity identity) : identity_(identity) {}

  template <class Message>
  void Add(const std::string& channel, Message message) {
    Stamp(message, identity_, utime_);
    events_.push_back({utime_, channel, Encoded(message)});
    utime_ += 1000;
  }
  std::vector<OwnedEvent> events() && { return std::move(events_); }

 private:
  RunIdentity identity_;
  int64_t utime_ = 1'700'000'000'000'000;
  std::vector<OwnedEvent> events_;
};

void AddVersions(const std::string& channel, const std::vector<std::shared_ptr<const Vector>>& versions,
                 Events& events) {
  for (size_t version = 0; version < versions.size(); ++version) {
    const std::span values(versions[version]->data(), static_cast<size_t>(versions[version]->size()));
    events.Add(channel, WeightsChunk(values, Crc32c(values), static_cast<int32_t>(version), 0));
  }
}

}  // namespace

std::vector<OwnedEvent> EventsOf(const RecordedRun& run, RunIdentity identity) {
  Events events(identity);
  for (const run_t& part : Announcement(run.experiment.Text(), kMaximumPartBytes)) {
    events.Add("FRESCO_RUN", part);
  }
  for (const world_t& names : WorldMessages(run.world)) {
    events.Add("FRESCO_WORLD", names);
  }
  AddVersions("FRESCO_WEIGHTS_CURRENT", run.current_versions, events);
  AddVersions("FRESCO_WEIGHTS_TARGET", run.target_versions, events);
  for (size_t i = 0; i < run.episodes.size(); ++i) {
    orders_t orders{};
    orders.order_count = 1;
    orders.orders = {ToWire(run.orders[i], 5, 0)};
    events.Add("FRESCO_ORDERS", orders);
    SplitResult(run.world, ResultOf(run.orders[i], run.episodes[i]), 5,
                [&](const transitions_t& message) { events.Add("FRESCO_TRANSITIONS", message); });
  }
  return std::move(events).events();
}

void WriteLog(const std::filesystem::path& path, const std::vector<OwnedEvent>& events) {
  EventLogWriter writer(path);
  for (const OwnedEvent& event : events) {
    writer.Write({0, event.utime, event.channel, event.message});
  }
  writer.Flush();
}

}  // namespace fresco
