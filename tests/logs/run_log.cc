#include "tests/logs/run_log.h"

#include <algorithm>

#include "core/bytes.h"
#include "logs/event_log_writer.h"
#include "msgs/weights_codec.h"

namespace fresco {
namespace {

class Events {
 public:
  explicit Events(RunIdentity identity) : identity_(identity) {}

  template <class Message>
  void Add(const std::string& channel, Message message) {
    Stamp(message, identity_, utime_);
    std::vector<std::byte> bytes;
    Encode(message, bytes);
    AddBytes(channel, std::move(bytes));
  }
  void AddBytes(const std::string& channel, std::vector<std::byte> bytes) {
    events_.push_back({utime_, channel, std::move(bytes)});
    utime_ += 1000;
  }
  std::vector<OwnedEvent> events() && { return std::move(events_); }

 private:
  RunIdentity identity_;
  int64_t utime_ = 1'700'000'000'000'000;
  std::vector<OwnedEvent> events_;
};

void AddConfiguration(const std::string& text, Events& events) {
  const size_t part_size = kMaximumPartBytes;
  const size_t parts = (text.size() + part_size - 1) / part_size;
  for (size_t part = 0; part < parts; ++part) {
    const std::string content = text.substr(part * part_size, part_size);
    run_t message{};
    message.part_size = static_cast<int32_t>(content.size());
    message.part.assign(content.begin(), content.end());
    message.part_index = static_cast<int32_t>(part);
    message.part_count = static_cast<int32_t>(parts);
    message.protocol_version = kProtocolVersion;
    message.arithmetic_fingerprint = ArithmeticFingerprint();
    events.Add("FRESCO_RUN", message);
  }
}

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
  AddConfiguration(run.experiment.Text(), events);
  AddVersions("FRESCO_WEIGHTS_CURRENT", run.current_versions, events);
  AddVersions("FRESCO_WEIGHTS_TARGET", run.target_versions, events);
  for (size_t i = 0; i < run.episodes.size(); ++i) {
    orders_t orders{};
    orders.order_count = 1;
    orders.orders = {ToWire(run.orders[i], 5, 0)};
    events.Add("FRESCO_ORDERS", orders);
    SplitResult(run.world, ResultOf(run.orders[i].index, run.episodes[i]), 5,
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
