#include "storage/policy.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/atomic_file.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/live_line.h"
#include "core/nearest_name.h"
#include "core/signals.h"
#include "storage/checkpoint_file.h"
#include "storage/run_folder.h"
#include "training/flyer.h"

namespace fresco {
namespace {

constexpr char kBestNetwork[] = "best.network";

std::string Describe(const World& world, const PlannerProgress& progress, double passed_s) {
  return fmt::format(
      "searching for {:.0f} s | slot {} of {} | {} labels of at most {} | average AoI between {:.4f} and "
      "{:.4f}",
      passed_s, progress.slot, world.scenario().slots, progress.labels, progress.width,
      progress.lower_bound_average, progress.best_average);
}

[[noreturn]] void RefusePolicy(const std::string& problem) {
  throw UsageError(fmt::format("--policy: expected {}; {}", kPolicyKinds, problem));
}

/// Returns the path of the network file or checkpoint that the policy names.
std::filesystem::path PolicyFile(const std::string& policy) {
  const std::filesystem::path path(policy);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    RefusePolicy(fmt::format("\"{}\" is none of these, and there is no such file{}", policy,
                             DidYouMean(policy, {kAoiPolicy, kDistancePolicy, kOptimalPolicy})));
  }
  if (!std::filesystem::is_directory(path, error)) {
    return path;
  }
  if (!std::filesystem::exists(path / kBestNetwork, error)) {
    RefusePolicy(
        fmt::format("the folder {} has no {}{}", policy, kBestNetwork, NewestRunHint(path, kBestNetwork)));
  }
  return path / kBestNetwork;
}

/// Returns the network of a network file, or the best one of a checkpoint.
StoredNetwork ReadPolicyFile(const std::filesystem::path& path) {
  const std::string content = ReadFile(path);
  if (!LooksLikeCheckpoint(content)) {
    return ParseNetworkFile(content, path.string());
  }
  const Checkpoint checkpoint = ParseCheckpoint(content, path.string());
  const std::optional<BestNetwork>& best = checkpoint.training.best;
  if (!best) {
    throw UsageError(fmt::format(
        "the checkpoint {} has no network yet: it was taken before the first evaluation", path.string()));
  }
  return {checkpoint.experiment, best->evaluation.version, best->evaluation.updates, *best->parameters};
}

}  // namespace

bool IsBuiltInPolicy(const std::string& policy) {
  return policy == kAoiPolicy || policy == kDistancePolicy || policy == kOptimalPolicy;
}

StoredNetwork ReadPolicy(const std::string& policy) {
  const std::filesystem::path path = PolicyFile(policy);
  try {
    return ReadPolicyFile(path);
  } catch (const Error& error) {
    RefusePolicy(error.what());
  }
}

Episode FlyNetwork(const World& world, const Experiment& experiment, const StoredNetwork& network) {
  const size_t trained_for = network.experiment.scenario().sensors.size();
  if (trained_for != world.scenario().sensors.size()) {
    throw UsageError(fmt::format("--policy: the network was trained for {} sensors, the scenario has {}",
                                 trained_for, world.sensors()));
  }
  return FlyGreedily(world, experiment, std::make_shared<const Vector>(network.parameters));
}

Plan PlanWithin(const World& world, const PlannerLimits& limits) {
  constexpr double kSilentS = 1;  // show no progress before; most searches end earlier
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
