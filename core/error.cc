#include "core/error.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace fresco {
namespace {

constexpr size_t kNotNear = std::numeric_limits<size_t>::max();

/// The edits between them; kNotNear if they are too many for a slip of the pen.
size_t EditsIfNear(std::string_view name, std::string_view candidate) {
  constexpr size_t kShortestPart = 3;
  const size_t longer = std::max(name.size(), candidate.size());
  const size_t difference = longer - std::min(name.size(), candidate.size());
  if (name.size() >= kShortestPart && (candidate.starts_with(name) || candidate.ends_with(name))) {
    return difference;
  }
  const size_t allowed = longer / 3;
  if (difference > allowed) {
    return kNotNear;  // before a table is made for a name of any length
  }
  const size_t edits = EditDistance(name, candidate);
  return edits <= allowed ? edits : kNotNear;
}

}  // namespace

Error Failure(const std::string& message) {
  return {ErrorKind::kFailure, message};
}

Error PluginFailure(const std::string& message) {
  return {ErrorKind::kPlugin, message};
}

Error UsageError(const std::string& message) {
  return {ErrorKind::kUsage, message};
}

void Expect(bool condition, const std::string& origin, const std::string& problem) {
  if (!condition) {
    throw UsageError(origin + ": " + problem);
  }
}

size_t EditDistance(std::string_view from, std::string_view to) {
  // edits[i][j]: between the first i characters of `from` and the first j of `to`.
  std::vector<std::vector<size_t>> edits(from.size() + 1, std::vector<size_t>(to.size() + 1));
  for (size_t i = 0; i <= from.size(); ++i) {
    for (size_t j = 0; j <= to.size(); ++j) {
      if (i == 0 || j == 0) {
        edits[i][j] = i + j;
        continue;
      }
      const size_t replaced = edits[i - 1][j - 1] + (from[i - 1] == to[j - 1] ? 0 : 1);
      edits[i][j] = std::min({edits[i - 1][j] + 1, edits[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1]) {
        edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
      }
    }
  }
  return edits[from.size()][to.size()];
}

std::optional<std::string> NearestName(std::string_view name, const std::vector<std::string>& candidates) {
  std::optional<std::string> nearest;
  size_t fewest = kNotNear;
  for (const std::string& candidate : candidates) {
    const size_t edits = EditsIfNear(name, candidate);
    if (edits < fewest) {
      fewest = edits;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string DidYouMean(std::string_view name, const std::vector<std::string>& candidates) {
  const std::optional<std::string> nearest = NearestName(name, candidates);
  return nearest ? "; did you mean " + *nearest + "?" : "";
}

void CheckFailed(const char* file, int line, const char* condition) {
  std::fprintf(stderr, "%s:%d: check failed: %s (a defect in Fresco; please report it)\n", file, line,
               condition);
  std::abort();
}

}  // namespace fresco
