// Gigabytes a second that `fresco log info` reads of a log, from the page cache. `log_info` reads a log that
// is mixed like a recorded run's, `log_info_transitions` one of the messages that have to be looked into
// most. The roof is reading the file and nothing else; the peer is LCM's own reader.
#include <fcntl.h>
#include <lcm/lcm.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "logs/event_log_writer.h"
#include "logs/log_summary.h"
#include "logs/merged_event_logs.h"
#include "tests/bench/alternate.h"
#include "tests/bench/subjects.h"
#include "tests/msgs/message_samples.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

constexpr int64_t kLogBytes = int64_t{64} << 20;

template <class Message>
std::vector<std::byte> Stamped(Message message, int64_t utime) {
  Stamp(message, {1, 2}, utime);
  return Encoded(message);
}

/// A part of an episode as the quick experiment's actors send them: three of 23 transitions are a whole one.
std::vector<std::byte> Transitions(RandomStream& stream, int64_t number, int64_t utime) {
  transitions_t message = TransitionsOf(stream, 23, 7, 20);
  message.order_index = number / 3;
  message.first_transition = static_cast<int32_t>(number % 3 * 23);
  message.ending = number % 3 == 2 ? 1 : 0;
  message.actor_id = 1 + number / 3 % 4;
  return Stamped(message, utime);
}

std::vector<std::byte> Status(RandomStream& stream, int64_t number, int64_t utime) {
  actor_status_t message = ActorStatusOf(stream, 8, 2, 12);
  message.actor_id = 1 + number % 4;
  message.sequence = number / 4;
  return Stamped(message, utime);
}

/// A log in the proportions of a recorded run: of ten events two of transitions, seven chunks of networks,
/// one of orders or a status. `transitions_only`: what has to be looked into most.
class SampleLog {
 public:
  explicit SampleLog(bool transitions_only) {
    RandomStream stream(1, RandomPurpose::kTest, 0, 0);
    EventLogWriter writer(path_);
    const auto chunk = Stamped(WeightsOf(stream, kValuesPerChunk), 1);
    int64_t transitions = 0;
    for (int64_t i = 0; writer.bytes() < kLogBytes; ++i) {
      const int64_t utime = 1'700'000'000'000'000 + 100 * i;
      const auto write = [&](const char* channel, const std::vector<std::byte>& message) {
        writer.Write({0, utime, channel, message});
      };
      if (transitions_only || i % 10 < 2) {
        write("FRESCO_TRANSITIONS", Transitions(stream, transitions++, utime));
      } else if (i % 10 < 9) {
        write("FRESCO_WEIGHTS_CURRENT", chunk);
      } else if (i % 20 == 9) {
        write("FRESCO_ORDERS", Stamped(OrdersOf(stream, 2), utime));
      } else {
        write("FRESCO_ACTOR_STATUS", Status(stream, i / 20, utime));
      }
    }
    writer.Flush();
  }
  const std::filesystem::path& path() const { return path_; }
  double bytes() const { return static_cast<double>(std::filesystem::file_size(path_)); }

 private:
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "log";
};

double ReadAlone(const SampleLog& log, std::vector<char>& block) {
  const int file = open(log.path().c_str(), O_RDONLY);
  double bytes = 0;
  for (ssize_t size = 0; (size = read(file, block.data(), block.size())) > 0;) {
    bytes += static_cast<double>(size);
  }
  close(file);
  return bytes;
}

double SumUp(const SampleLog& log) {
  MergedEventLogs logs({log.path()});
  LogSummary summary;
  while (const auto event = logs.Next()) {
    summary.Take(*event);
  }
  FRESCO_CHECK(summary.events() > 0);
  return log.bytes();
}

double ReadByLcm(const SampleLog& log) {
  lcm_eventlog_t* file = lcm_eventlog_create(log.path().c_str(), "r");
  double bytes = 0;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(file)) {
    bytes += event->datalen;
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_destroy(file);
  FRESCO_CHECK(bytes > 0);
  return log.bytes();
}

/// Two rows: beside read(), and beside LCM's reader.
Results LogInfo(const std::string& name, bool transitions_only, double seconds) {
  constexpr double kGiga = 1e9;
  const SampleLog log(transitions_only);
  std::vector<char> block(1 << 20);
  const Speeds speeds =
      Alternate([&] { return SumUp(log); },
                {[&] { return ReadAlone(log, block); }, [&] { return ReadByLcm(log); }}, seconds);
  const double speed = speeds.value / kGiga;
  return {{MoreIsBetter(name, speed, "GB/s", "read() of the same file from the page cache, and nothing else",
                        speeds.references[0] / kGiga),
           MoreIsBetter(name + "_lcm", speed, "GB/s", "LCM's own reader, which does not look into messages",
                        speeds.references[1] / kGiga)},
          {}};
}

}  // namespace

std::vector<Subject> LogSubjects() {
  const auto subject = [](const std::string& name, bool transitions_only) {
    return Subject{{name, name + "_lcm"},
                   [=](double seconds) { return LogInfo(name, transitions_only, seconds); }};
  };
  return {subject("log_info", false), subject("log_info_transitions", true)};
}

}  // namespace fresco
