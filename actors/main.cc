// The program fresco-actor: one actor process. It needs nothing but an LCM URL; see actors/actor.h.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "actors/actor.h"
#include "bus/open_bus.h"
#include "core/clock.h"
#include "core/command_line.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "core/signals.h"
#include "nn/arithmetic.h"
#include "nn/arithmetic_option.h"

namespace fresco {
namespace {

struct Arguments {
  std::string lcm_url = kDefaultLcmUrl;
  std::string channel_prefix = kDefaultChannelPrefix;
  std::string run_id;
  int environments = 0;
  std::vector<std::string> allowed_code;
  BusOptions bus;
  bool once = false;
};

std::string HostName() {
  char name[64] = "unknown";
  static_cast<void>(gethostname(name, sizeof name - 1));
  return name;
}

ActorOptions OptionsFrom(const Arguments& arguments) {
  ActorOptions options;
  options.actor_id = DrawIdentifier();
  options.host = HostName();
  options.pid = static_cast<int32_t>(getpid());
  if (!arguments.run_id.empty()) {
    options.run_id = ParseRunId(arguments.run_id);
  }
  options.allowed_code.assign(arguments.allowed_code.begin(), arguments.allowed_code.end());
  if (arguments.environments > 0) {
    options.capacity = arguments.environments;
  }
  return options;
}

void Serve(const Arguments& arguments) {
  constexpr int64_t kWaitUs = 2'000;
  const std::unique_ptr<Bus> bus = OpenBus(arguments.lcm_url, arguments.bus);
  Actor actor(*bus, ChannelsWithPrefix(arguments.channel_prefix), OptionsFrom(arguments));
  spdlog::info("waiting for a run on {}; arithmetic {}", arguments.lcm_url, CurrentArithmetic().name);
  while (!StopSignal::Requested() && !(arguments.once && actor.run_over())) {
    const bool busy = actor.Step(MonotonicMicroseconds());
    bus->Poll(busy ? 0 : kWaitUs);
    if (StateSignal::ConsumeRequest()) {
      spdlog::info("{}", actor.StateText());
    }
  }
  spdlog::info("{}", actor.Description());
}

int Main(int argc, char** argv) {
  Arguments arguments;
  Program program(
      "fresco-actor",
      "Flies episodes for Fresco's learner: waits for a run on the bus, serves it, and waits for the next "
      "one.",
      LogStyle::kTimed, {kSourceCommit, CurrentArithmetic().name});
  CLI::App& app = program.command_line();
  app.add_option("--lcm-url", arguments.lcm_url, "LCM URL of the learner")
      ->type_name("URL")
      ->capture_default_str();
  app.add_option("--channel-prefix", arguments.channel_prefix, "First part of the channels' names")
      ->type_name("PREFIX")
      ->capture_default_str();
  app.add_option("--run-id", arguments.run_id, "Serve this run only (16 hexadecimal digits)")
      ->type_name("RUN_ID");
  AddBusOptions(app, arguments.bus);
  app.add_option("--environments", arguments.environments,
                 "Episodes flown side by side; 0: as the run's configuration says")
      ->check(CLI::Range(0, 4096));
  app.add_option(
         "--allow-code", arguments.allowed_code,
         "A plug-in's library or a Python module's file that a run may make this actor run; may be repeated")
      ->type_name("FILE");
  AddArithmeticOption(app);
  app.add_flag("--once", arguments.once, "End with the first run instead of waiting for the next");
  return program.Run(argc, argv, [&] {
    Serve(arguments);
    return 0;
  });
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  return fresco::Main(argc, argv);
}
