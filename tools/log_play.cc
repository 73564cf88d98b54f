#include <fmt/format.h>

#include <memory>

#include "core/error.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "logs/event_input.h"
#include "logs/log_player.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct PlayOptions {
  EventInputOptions input;
  double speed = 1;
  bool loop = false;
  std::string lcm_url = kDefaultLcmUrl;
};

/// Plays the logs once. Returns at the end, or if the program is asked to stop.
void PlayOnce(const PlayOptions& options, LogPlayer& player) {
  EventInput input(options.input);
  LiveLine line(true);
  while (const auto event = input.Next()) {
    player.Play(*event);
    line.Show(
        fmt::format("played {} events; at {:.1f} s of the log", player.events(), input.SecondsOf(*event)));
  }
  input.WarnOfLosses();
}

int Play(const PlayOptions& options) {
  EventInput(options.input);  // checks the options before a bus is opened
  const auto bus = OpenLcmBus(options.lcm_url);
  LogPlayer player(*bus, options.speed);
  do {
    const int64_t events_before = player.events();
    player.StartAgain();
    PlayOnce(options, player);
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
  play->add_option("--lcm-url", options->lcm_url, "LCM URL to play on")->capture_default_str();
  play->callback([options, &command] { command = [options] { return Play(*options); }; });
}

}  // namespace fresco
