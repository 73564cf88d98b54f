// The subcommand `fresco log play`: publishes the events of logs on a bus again, with unchanged bytes.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "bus/bus.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/help_formatter.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "logs/event_input.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

// These limits give 20,000 messages of one frame a second. At this rate receivers with default buffers lose
// nothing.
constexpr int kBurstEvents = 8;
constexpr size_t kBurstBytes = 8 * 1400;
constexpr int64_t kBurstUs = 400;

struct PlayOptions {
  EventInputOptions input;
  double speed = 1;
  bool loop = false;
  std::string lcm_url = kDefaultLcmUrl;
};

/// Sleeps until then. Returns early if the program is asked to stop.
void SleepUntil(int64_t monotonic_us) {
  constexpr int64_t kSliceUs = 100'000;  // sleep in slices, since a signal may come just before a sleep
                                         // begins
  int64_t left_us = monotonic_us - MonotonicMicroseconds();
  while (left_us > 0 && !StopSignal::Requested()) {
    const timespec slice{0, std::min(left_us, kSliceUs) * 1000};
    nanosleep(&slice, nullptr);
    left_us = monotonic_us - MonotonicMicroseconds();
  }
}

class Player {
 public:
  Player(const PlayOptions& options, Bus& bus) : options_(options), bus_(bus) {}

  /// Plays the logs once. Returns at the end, or if the program is asked to stop.
  void PlayOnce() {
    EventInput input(options_.input);
    LiveLine line(true);
    first_.reset();
    while (const auto event = input.Next()) {
      Play(*event);
      line.Show(fmt::format("played {} events; at {:.1f} s of the log", events_, input.SecondsOf(*event)));
    }
    input.WarnOfLosses();
  }

  /// The number of events published.
  int64_t events() const { return events_; }
  /// The number of events that the bus could not send.
  int64_t refused() const { return refused_; }

 private:
  struct Beginning {
    int64_t utime;
    int64_t monotonic_us;
  };

  /// Waits until it is time for the event, or until the program is asked to stop, and publishes it.
  void Play(const LcmEvent& event) {
    WaitForItsTime(event);
    Pace(event.message.size());
    if (!StopSignal::Requested()) {
      ++events_;
      refused_ += bus_.Publish(std::string(event.channel), event.message) ? 0 : 1;
    }
  }

  void WaitForItsTime(const LcmEvent& event) {
    if (!first_) {
      first_ = {event.utime, MonotonicMicroseconds()};
    }
    if (options_.speed > 0) {
      constexpr double kLongestUs = 1e15;  // a damaged event may have any time
      const double after_us =
          (static_cast<double>(event.utime) - static_cast<double>(first_->utime)) / options_.speed;
      SleepUntil(first_->monotonic_us + static_cast<int64_t>(std::clamp(after_us, 0.0, kLongestUs)));
    }
  }

  /// Waits if need be, so that there is at most one burst every 0.4 ms, and a longer pause after a large
  /// message.
  void Pace(size_t bytes) {
    if (burst_events_ == kBurstEvents || burst_bytes_ >= kBurstBytes) {
      const auto share = static_cast<int64_t>(burst_bytes_ / kBurstBytes);
      SleepUntil(burst_begin_us_ + kBurstUs * std::max<int64_t>(1, share));
      burst_events_ = 0;
      burst_bytes_ = 0;
    }
    if (burst_events_ == 0) {
      burst_begin_us_ = MonotonicMicroseconds();
    }
    ++burst_events_;
    burst_bytes_ += bytes;
  }

  const PlayOptions& options_;
  Bus& bus_;
  std::optional<Beginning> first_;  // of this pass through the logs
  int64_t burst_begin_us_ = 0;
  int burst_events_ = 0;
  size_t burst_bytes_ = 0;
  int64_t events_ = 0;
  int64_t refused_ = 0;
};

int Play(const PlayOptions& options) {
  EventInput(options.input);  // checks the options before a bus is opened
  const auto bus = OpenLcmBus(options.lcm_url);
  Player player(options, *bus);
  do {
    const int64_t events_before = player.events();
    player.PlayOnce();
    if (player.events() == events_before) {
      break;  // nothing to play, or asked to stop
    }
  } while (options.loop && !StopSignal::Requested());
  fmt::print("played {} events on {}\n", player.events(), options.lcm_url);
  if (player.refused() > 0) {
    throw Failure(fmt::format("{} of {} events could not be sent over {}", player.refused(), player.events(),
                              options.lcm_url));
  }
  return StopSignal::Requested() && !options.loop ? 1 : 0;
}

}  // namespace

void AddLogPlay(CLI::App& log, Command& command) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* play = log.add_subcommand("play", "Publish events on a bus again, with unchanged bytes");
  AddEventInput(*play, options->input);
  play->add_option("--speed", options->speed,
                   "How many times as fast as recorded; 0: as fast as receivers can follow")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6));
  play->add_flag("--loop", options->loop, "Play again and again, until Ctrl-C");
  play->add_option("--lcm-url", options->lcm_url, "LCM URL to play on")
      ->type_name("URL")
      ->capture_default_str();
  play->footer(HelpExamples(
      {"fresco log play run.lcm", "fresco log play run.lcm --speed 10 --start 60 --stop 120 --loop"}));
  play->callback([options, &command] { command = [options] { return Play(*options); }; });
}

}  // namespace fresco
