// The program fresco-world: shows what the world of a plug-in is, and tries it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "core/clock.h"
#include "core/command_line.h"
#include "core/error.h"
#include "core/installation.h"
#include "core/random.h"
#include "core/signals.h"
#include "plugins/plugin_world.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

struct Arguments {
  PluginSpec spec;
  int episodes = 10;
  uint64_t seed = 1;
};

/// Random actions among the allowed ones, until the episode ends.
Episode PlayAtRandom(const World& world, uint64_t seed) {
  RandomStream stream(seed, RandomPurpose::kTest, 0, 0);
  EpisodeRecorder recorder(world, seed);
  while (!recorder.ended() && !StopSignal::Requested()) {
    recorder.Step(RandomAllowedAction(recorder.mask(), stream));
  }
  return recorder.Release();
}

int Describe(const Arguments& arguments) {
  fmt::print("{}\n", ToJson(PluginLibrary(arguments.spec).description()));
  return 0;
}

/// Whether the actions of an episode lead to the same in the episode of another seed.
bool SeedDecidesNothing(const World& world, const Episode& episode, uint64_t other_seed) {
  Episode other;
  return FlyActions(world, other_seed, episode.actions, other) && SameBits(episode, other);
}

/// Plays every episode twice; the second time while another one is being played. In a world without chance,
/// plays it with another seed, too. Returns the exit status.
int Check(const Arguments& arguments) {
  const PluginWorld world(arguments.spec, DescribePlugin(arguments.spec));
  int64_t steps = 0;
  int64_t different = 0;
  int64_t by_chance = 0;
  const int64_t begin_us = MonotonicMicroseconds();
  for (int i = 0; i < arguments.episodes && !StopSignal::Requested(); ++i) {
    const uint64_t seed = arguments.seed + static_cast<uint64_t>(i);
    const Episode first = PlayAtRandom(world, seed);
    EpisodeRecorder beside(world, seed + 1);
    beside.Step(0);
    const Episode second = PlayAtRandom(world, seed);
    steps += first.transitions() + second.transitions();
    different += SameBits(first, second) ? 0 : 1;
    const bool has_chance = world.description().random;
    by_chance += has_chance || SeedDecidesNothing(world, first, seed + 1) ? 0 : 1;
    fmt::print("seed {}: {} steps, return {:g}, {}{}\n", seed, first.transitions(), Return(first),
               first.ending == Ending::kTerminal ? "terminal" : "truncated",
               SameBits(first, second) ? "" : "; DIFFERENT when played again");
  }
  const double seconds = 1e-6 * static_cast<double>(MonotonicMicroseconds() - begin_us);
  fmt::print("{} steps, {:.0f} a second\n", steps, static_cast<double>(steps) / std::max(seconds, 1e-6));
  if (different > 0) {
    throw Failure(
        fmt::format("{} of {} episodes are not functions of their seed and actions, so a run would not be "
                    "repeatable",
                    different, arguments.episodes));
  }
  if (by_chance > 0) {
    throw Failure(fmt::format("{} of {} episodes are others with another seed, but without_chance is 1",
                              by_chance, arguments.episodes));
  }
  fmt::print("every episode was the same when played again\n");
  return 0;
}

int Main(int argc, char** argv) {
  Arguments arguments;
  std::function<int()> command;
  Program program("fresco-world", "Shows and tries the world of a plug-in (fresco/world.h).",
                  LogStyle::kPlain, {kSourceCommit});
  CLI::App& app = program.command_line();
  app.require_subcommand(1);
  const auto add = [&](const char* name, const char* description, int (*run)(const Arguments&)) {
    CLI::App* subcommand = app.add_subcommand(name, description);
    subcommand->add_option("--library", arguments.spec.library, "Path of the shared library")
        ->type_name("FILE")
        ->required();
    subcommand->add_option("--settings", arguments.spec.settings, "Text for the library")->type_name("TEXT");
    subcommand->add_option("--call-limit-s", arguments.spec.call_limit_s, "Seconds that a call may take")
        ->capture_default_str()
        ->check(CLI::Range(0.001, 1e6));
    subcommand->callback(
        [&command, &arguments, run] { command = [&arguments, run] { return run(arguments); }; });
    return subcommand;
  };
  add("describe", "Print what the world is, as JSON", Describe);
  CLI::App* check = add("check", "Play random episodes twice, and compare them to the bit", Check);
  check->add_option("--episodes", arguments.episodes, "How many")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  check->add_option("--seed", arguments.seed, "Seed of the first one; the others follow")
      ->capture_default_str();
  return program.Run(argc, argv, [&] { return command(); });
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  return fresco::Main(argc, argv);
}
