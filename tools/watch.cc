#include <curses.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>

#include "bus/bus.h"
#include "core/clock.h"
#include "core/help_formatter.h"
#include "core/signals.h"
#include "msgs/channels.h"
#include "report/run_watch.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct WatchOptions {
  std::string lcm_url = kDefaultLcmUrl;
  std::string channel_prefix = kDefaultChannelPrefix;
  bool once = false;
};

/// The terminal as curses uses it; restores it at the end.
class Terminal {
 public:
  Terminal() : screen_(newterm(nullptr, stdout, stdin)) {
    if (screen_ != nullptr) {
      noecho();
      curs_set(0);
      nodelay(stdscr, TRUE);
    }
  }
  ~Terminal() {
    if (screen_ != nullptr) {
      endwin();
      delscreen(screen_);
    }
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// False if the terminal can't do that.
  bool usable() const { return screen_ != nullptr; }
  /// Shows the text. Long lines go on in the next one; what does not fit below is cut off.
  void Show(const std::string& text) {
    werase(stdscr);
    mvwaddstr(stdscr, 0, 0, text.c_str());
    wrefresh(stdscr);
  }
  /// Whether the user has pressed q.
  bool ShallQuit() { return wgetch(stdscr) == 'q'; }

 private:
  SCREEN* screen_;
};

/// Listens for so long, or until the program is asked to stop.
void Listen(Bus& bus, int64_t duration_us) {
  for (const int64_t end_us = MonotonicMicroseconds() + duration_us;
       MonotonicMicroseconds() < end_us && !StopSignal::Requested();) {
    bus.Poll(end_us - MonotonicMicroseconds());
  }
}

int Watch(const WatchOptions& options) {
  constexpr int64_t kOnceUs = 2'500'000;  // a learner sends the names of its world every second
  constexpr int64_t kFrameUs = 500'000;
  RunWatch watch(ChannelsWithPrefix(options.channel_prefix));
  const auto bus = OpenLcmBus(options.lcm_url);
  bus->SubscribeToAll([&](const LcmEvent& event) { watch.Add(event, MonotonicMicroseconds()); });
  if (options.once) {
    Listen(*bus, kOnceUs);
    fmt::print("{}", watch.Text(MonotonicMicroseconds()));
    return watch.HasRun() ? 0 : 1;
  }
  std::unique_ptr<Terminal> terminal;
  if (isatty(STDOUT_FILENO) != 0 && isatty(STDIN_FILENO) != 0) {
    terminal = std::make_unique<Terminal>();
  }
  const bool drawn = terminal != nullptr && terminal->usable();
  while (!StopSignal::Requested() && !(drawn && terminal->ShallQuit())) {
    Listen(*bus, drawn ? kFrameUs : kOnceUs);
    const std::string text = watch.Text(MonotonicMicroseconds());
    if (drawn) {
      terminal->Show(text + "\nq ends\n");
    } else {
      fmt::print("{}\n", text);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace

void AddWatch(CLI::App& app, Command& command) {
  auto options = std::make_shared<WatchOptions>();
  CLI::App* watch =
      app.add_subcommand("watch", "Watch all runs on the bus in the terminal: learners, actors, losses");
  watch->add_option("--lcm-url", options->lcm_url, "LCM URL of the runs")
      ->type_name("URL")
      ->capture_default_str();
  watch->add_option("--channel-prefix", options->channel_prefix, "First part of the channels' names")
      ->type_name("PREFIX")
      ->capture_default_str();
  watch->add_flag("--once", options->once,
                  "Listen for 2.5 seconds and print what was heard as text; exit status 1 if that is no run");
  watch->footer(
      HelpExamples({"fresco watch", "fresco watch --once --lcm-url 'udpm://239.255.76.67:7667?ttl=1'"}));
  watch->callback([options, &command] { command = [options] { return Watch(*options); }; });
}

}  // namespace fresco
