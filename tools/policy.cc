#include "tools/policy.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "actors/flyer.h"
#include "core/atomic_file.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/signals.h"
#include "msgs/checkpoint_file.h"
#include "tools/live_line.h"

namespace fresco {
namespace {

std::string Describe(const World& world, const PlannerProgress& progress, double passed_s) {
  return fmt::format(
      "searching for {:.0f} s | slot {} of {} | {} labels of {} at most | average AoI between {:.4f} and "
      "{:.4f}",
      passed_s, progress.slot, world.scenario().slots, progress.labels, progress.width,
      progress.lower_bound_average, progress.best_average);
}

}  // namespace

StoredNetwork ReadPolicy(const std::string& policy) {
  std::filesystem::path path(policy);
  if (!std::filesystem::exists(path)) {
    throw UsageError(fmt::format(
        "--policy: expected aoi, distance, optimal, a run's folder, a network file or a checkpoint; "
        "\"{}\" is none of them",
        policy));
  }
  if (std::filesystem::is_directory(path)) {
    path /= "best.network";
  }
  const std::string content = ReadFile(path);
  if (!LooksLikeCheckpoint(content)) {
    return ParseNetworkFile(content, path.string());
  }
  const Checkpoint checkpoint = ParseCheckpoint(content, path.string());
  const std::optional<BestNetwork>& best = checkpoint.training.best;
  if (!best) {
    throw UsageError(fmt::format("--policy: nothing was evaluated before the checkpoint {}", path.string()));
  }
  return {checkpoint.experiment, best->evaluation.version, best->evaluation.updates, *best->parameters};
}

Flight FlyNetwork(const World& world, const Experiment& experiment, const StoredNetwork& network) {
  const size_t trained_for = network.experiment.scenario().sensors.size();
  if (trained_for != world.scenario().sensors.size()) {
    throw UsageError(fmt::format("--policy: the network was trained for {} sensors, the scenario has {}",
                                 trained_for, world.sensors()));
  }
  const Episode episode = FlyGreedily(world, experiment, std::make_shared<const Vector>(network.parameters));
  size_t next = 0;
  return Fly(world, [&](const Environment&) { return world.ActionAt(episode.actions[next++]); });
}

Plan PlanWithin(const World& world, const PlannerLimits& limits) {
  constexpr double kSilentS = 1;  // most searches are over by then
  const int64_t begin_us = MonotonicMicroseconds();
  LiveLine line(limits.show_progress);
  PlannerOptions options;
  options.memory_bytes = limits.memory_bytes;
  options.keep_going = [&](const PlannerProgress& progress) {
    const double passed_s = static_cast<double>(MonotonicMicroseconds() - begin_us) * 1e-6;
    if (passed_s > kSilentS) {
      line.Show(Describe(world, progress, passed_s));
    }
    return !StopSignal::Requested() && (limits.seconds <= 0 || passed_s < limits.seconds);
  };
  return PlanOptimally(world, options);
}

}  // namespace fresco
