#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "bus/open_bus.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/help_formatter.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "msgs/channels.h"
#include "msgs/message_bus.h"
#include "msgs/protocol_times.h"
#include "msgs/worlds.h"
#include "storage/policy.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

struct FlyOptions {
  PolicyChoice choice;
  uint64_t episode_seed = 0;
  double slots_per_s = 5;
  bool loop = false;
  std::string lcm_url;
  BusOptions bus;
};

/// Publishes a flight slot by slot. Its clock stops while the process is stopped, so it continues at the same
/// pace afterwards.
class FlightShow {
 public:
  FlightShow(const FlownPolicy& flown, const FlyOptions& options, std::unique_ptr<Bus> bus)
      : flown_(flown),
        messages_(FlightMessages(flown.experiment, flown.episode, EpisodeName(flown, options.choice.policy))),
        field_(ScenarioMessages(flown.experiment, flown.episode)),
        bus_(std::move(bus)),
        message_bus_(*bus_),
        channels_(ChannelsWithPrefix(flown.experiment.run().channel_prefix())),
        period_us_(1e6 / options.slots_per_s) {}

  /// Publishes the flight once. Returns false if the program was asked to stop before the end of the flight.
  bool Show() {
    const int64_t begin_us = clock_.Look(MonotonicMicroseconds());
    SendField();
    for (size_t slot = 0; slot < messages_.size(); ++slot) {
      if (!WaitUntil(begin_us + static_cast<int64_t>(static_cast<double>(slot) * period_us_))) {
        return false;
      }
      Send(channels_.flight, messages_[slot]);
      line_.Show(Describe(messages_[slot]));
    }
    for (flight_t& message : messages_) {
      ++message.flight;
    }
    return WaitUntil(clock_.now_us() + std::max(kLastSlotUs, static_cast<int64_t>(period_us_)));
  }

 private:
  // How long the last slot is shown before the next flight begins.
  static constexpr int64_t kLastSlotUs = 1'000'000;
  static constexpr int64_t kLongestPollUs = 20'000;

  /// Returns false if the program was asked to stop.
  bool WaitUntil(int64_t due_us) {
    while (!StopSignal::Requested()) {
      const int64_t now_us = clock_.Look(MonotonicMicroseconds());
      if (now_us >= due_us) {
        return true;
      }
      if (now_us >= next_field_us_) {
        SendField();
      }
      bus_->Poll(std::min(kLongestPollUs, due_us - now_us));
    }
    return false;
  }

  void SendField() {
    next_field_us_ = clock_.now_us() + kWorldPeriodUs;
    for (const scenario_t& message : field_) {
      Send(channels_.scenario, message);
    }
  }

  template <class Message>
  void Send(const std::string& channel, Message message) {
    if (!message_bus_.Publish(channel, std::move(message), identity_) && !failure_was_told_) {
      failure_was_told_ = true;
      spdlog::warn("{}: LCM could not send a message; is the network up?", channel);
    }
  }

  static std::string Describe(const flight_t& message) {
    const auto sums = static_cast<double>(message.slot) * message.sensor_count;
    return fmt::format(
        "flight {} | slot {} of {} | over ({},{}) | mean AoI so far {:.3f} slots | {:.0f} J left | AoI {}",
        message.flight + 1, message.slot, message.slots, message.column, message.row,
        static_cast<double>(message.total_aoi) / sums, message.remaining_energy_j,
        fmt::join(message.aoi, " "));
  }

  const FlownPolicy& flown_;
  std::vector<flight_t> messages_;
  std::vector<scenario_t> field_;
  std::unique_ptr<Bus> bus_;
  MessageBus message_bus_;
  Channels channels_;
  RunIdentity identity_{DrawIdentifier(), flown_.experiment.hash()};
  double period_us_;
  AttentiveClock clock_;
  LiveLine line_{true};
  int64_t next_field_us_ = 0;
  bool failure_was_told_ = false;
};

/// Returns the exit status: 0 if the flight was published completely. With --loop it never is, so any end is
/// 0.
int FlyOverBus(const FlyOptions& options) {
  const ChosenPolicy chosen = ReadChoice(options.choice);
  if (!HasFlights(chosen.experiment)) {
    throw UsageError(
        fmt::format("fresco fly: the world {} has no flights; only the UAV's world (scenario) has",
                    chosen.experiment.world().description().name));
  }
  const std::string url = options.lcm_url.empty() ? chosen.experiment.run().lcm_url() : options.lcm_url;
  std::unique_ptr<Bus> bus =
      OpenBus(url, options.bus);  // before the search for the optimum, which may take long
  const FlownPolicy flown = FlyPolicy(options.choice, chosen, options.episode_seed);
  if (StopSignal::Requested()) {
    return 1;
  }
  FlightShow show(flown, options, std::move(bus));
  spdlog::info("{} on {}_FLIGHT, {} slots a second; watch it with: {} spy --open flight --lcm-url '{}'",
               options.choice.policy, flown.experiment.run().channel_prefix(), options.slots_per_s,
               ProgramName(), url);
  bool whole = show.Show();
  while (options.loop && whole) {
    whole = show.Show();
  }
  fmt::print("{}\n", EpisodeSummary(flown, options.choice.policy));
  return whole || options.loop ? 0 : 1;
}

}  // namespace

void AddFly(CLI::App& app, Command& command) {
  auto options = std::make_shared<FlyOptions>();
  CLI::App* fly =
      app.add_subcommand("fly", "Fly one episode greedily and publish it slot by slot over LCM, for viewers");
  AddPolicyOptions(*fly, options->choice);
  fly->add_option(
      "--episode-seed", options->episode_seed,
      "If every episode has a field of its own: the seed that draws it, as `evaluate --format json` "
      "prints it; default: 0");
  fly->add_option("--rate", options->slots_per_s, "Slots a second")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1000.0));
  fly->add_flag("--loop", options->loop, "Fly it again and again, until Ctrl-C");
  fly->add_option("--lcm-url", options->lcm_url,
                  "LCM URL to publish on; default: the experiment's run.lcm_url")
      ->type_name("URL");
  AddBusOptions(*fly, options->bus);
  options->choice.limits.show_progress = true;
  fly->footer(HelpExamples({"fresco fly --policy runs/NAME --loop", "fresco fly --policy optimal --rate 2"}));
  fly->callback([options, &command] { command = [options] { return FlyOverBus(*options); }; });
}

}  // namespace fresco
