// The best episodes that the planner found for a run, and what is proved about them: optimum.json in the
// run's folder. Any thread may call these functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "planner/planner.h"

namespace fresco {

inline constexpr char kOptimumFile[] = "optimum.json";

/// Returns the JSON object of optimum.json. `episodes` has an object for each plan that is not null: the seed
/// of its episode, `optimal`, its figures, the lower bounds, and `actions`, the indices of its actions.
std::string OptimumJson(const World& world, std::span<const uint64_t> seeds,
                        std::span<const std::shared_ptr<const Plan>> plans);

/// Reads the plans of the episodes of `seeds` from a run's folder. Null where there is none. If the file
/// can't be used, logs a warning that says why, and returns no plan.
std::vector<std::shared_ptr<const Plan>> PlansIn(const std::filesystem::path& folder, const World& world,
                                                 std::span<const uint64_t> seeds);

}  // namespace fresco
