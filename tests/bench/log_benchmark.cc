// How fast `fresco log info` goes through a log, beside reading the file and nothing else (the roof), and
// LCM's own reader, which does not look into messages: in one run, from the page cache. The shares are
// printed last.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <lcm/lcm.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "logs/event_log_writer.h"
#include "logs/log_summary.h"
#include "logs/merged_event_logs.h"
#include "tests/bench/share_reporter.h"
#include "tests/msgs/message_samples.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

constexpr int64_t kLogBytes = int64_t{256} << 20;

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

 private:
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "log";
};

void CountBytes(benchmark::State& state, const SampleLog& log) {
  state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                          static_cast<int64_t>(std::filesystem::file_size(log.path())));
}

void Read(benchmark::State& state, bool transitions_only) {
  const SampleLog log(transitions_only);
  std::vector<char> block(1 << 20);
  for (auto _ : state) {
    const int file = open(log.path().c_str(), O_RDONLY);
    while (read(file, block.data(), block.size()) > 0) {
      benchmark::ClobberMemory();
    }
    close(file);
  }
  CountBytes(state, log);
}

void Info(benchmark::State& state, bool transitions_only) {
  const SampleLog log(transitions_only);
  for (auto _ : state) {
    MergedEventLogs logs({log.path()});
    LogSummary summary;
    while (const auto event = logs.Next()) {
      summary.Take(*event);
    }
    benchmark::DoNotOptimize(summary.events());
  }
  CountBytes(state, log);
}

void LcmReader(benchmark::State& state, bool transitions_only) {
  const SampleLog log(transitions_only);
  for (auto _ : state) {
    lcm_eventlog_t* file = lcm_eventlog_create(log.path().c_str(), "r");
    while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(file)) {
      benchmark::DoNotOptimize(event->datalen);
      lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(file);
  }
  CountBytes(state, log);
}

BENCHMARK_CAPTURE(Read, run, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Info, run, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(LcmReader, run, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Read, transitions, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Info, transitions, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(LcmReader, transitions, true)->Unit(benchmark::kMillisecond)->UseRealTime();

void PrintShares(const BenchmarkSeconds& all) {
  for (const std::string log : {"run", "transitions"}) {
    const auto read = all.find("Read/" + log);
    const auto info = all.find("Info/" + log);
    const auto lcm = all.find("LcmReader/" + log);
    if (read != all.end() && info != all.end() && lcm != all.end()) {
      std::printf(
          "%-11s: log info goes at %.2f GB/s, %.0f %% of the speed of read() alone, %.1f times that of "
          "LCM's reader\n",
          log.c_str(), 1e-9 * static_cast<double>(kLogBytes) / info->second,
          100 * read->second / info->second, lcm->second / info->second);
    }
  }
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  return fresco::RunBenchmarks(argc, argv, fresco::PrintShares);
}
