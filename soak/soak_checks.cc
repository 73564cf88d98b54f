#include "soak/soak_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/files.h"

namespace fresco {
namespace {

using Json = nlohmann::json;

constexpr int kMoreDescriptors = 4;

double ToMib(int64_t kib) {
  return static_cast<double>(kib) / 1024;
}

void Compare(const char* what, int64_t expected, int64_t found, std::vector<std::string>& differences) {
  if (expected != found) {
    differences.push_back(fmt::format("{}: {} undisturbed, {} here", what, expected, found));
  }
}

}  // namespace

bool IsComplete(const std::filesystem::path& folder) {
  const auto path = folder / "summary.json";
  if (!std::filesystem::exists(path)) {
    return false;
  }
  return Json::parse(ReadFile(path)).at("completed").get<bool>();
}

RunFacts ReadRunFacts(const std::filesystem::path& folder) {
  const Json summary = Json::parse(ReadFile(folder / "summary.json"));
  RunFacts facts;
  facts.weights_crc32c = summary.at("weights_crc32c").get<std::string>();
  facts.final_network = ReadFile(folder / "final.network");
  facts.episodes = summary.at("episodes").get<int64_t>();
  facts.transitions = summary.at("transitions").get<int64_t>();
  facts.updates = summary.at("updates").get<int64_t>();
  facts.total_aoi = summary.at("total_aoi").is_null() ? -1 : summary.at("total_aoi").get<int64_t>();
  return facts;
}

std::vector<std::string> Differences(const RunFacts& undisturbed, const RunFacts& disturbed) {
  std::vector<std::string> differences;
  if (undisturbed.weights_crc32c != disturbed.weights_crc32c) {
    differences.push_back(fmt::format("the final weights' CRC-32C: {} undisturbed, {} here",
                                      undisturbed.weights_crc32c, disturbed.weights_crc32c));
  } else if (undisturbed.final_network != disturbed.final_network) {
    differences.push_back("final.network differs in its bytes");
  }
  Compare("episodes", undisturbed.episodes, disturbed.episodes, differences);
  Compare("transitions", undisturbed.transitions, disturbed.transitions, differences);
  Compare("updates", undisturbed.updates, disturbed.updates, differences);
  Compare("the best policy's total AoI", undisturbed.total_aoi, disturbed.total_aoi, differences);
  return differences;
}

std::vector<std::string> Excesses(const UseByProgram& undisturbed, const UseByProgram& disturbed,
                                  int64_t memory_allowance_kib) {
  std::vector<std::string> excesses;
  for (const auto& [program, use] : disturbed) {
    const auto before = undisturbed.find(program);
    if (before == undisturbed.end()) {
      continue;
    }
    const ProcessUse& usual = before->second;
    const int64_t memory_limit_kib = usual.peak_kib + usual.peak_kib / 4 + memory_allowance_kib;
    if (use.peak_kib > memory_limit_kib) {
      excesses.push_back(fmt::format("{}: peak memory {:.0f} MiB, {:.0f} MiB undisturbed, {:.0f} MiB allowed",
                                     program, ToMib(use.peak_kib), ToMib(usual.peak_kib),
                                     ToMib(memory_limit_kib)));
    }
    if (use.descriptors > usual.descriptors + kMoreDescriptors) {
      excesses.push_back(fmt::format("{}: {} open descriptors at most, {} undisturbed, {} allowed", program,
                                     use.descriptors, usual.descriptors,
                                     usual.descriptors + kMoreDescriptors));
    }
  }
  return excesses;
}

double Growth(const std::vector<double>& series) {
  constexpr size_t kFewest = 4;
  if (series.size() < kFewest) {
    return 0;
  }
  std::vector<double> slopes;
  for (size_t i = 0; i < series.size(); ++i) {
    for (size_t j = i + 1; j < series.size(); ++j) {
      slopes.push_back((series[j] - series[i]) / static_cast<double>(j - i));
    }
  }
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  return *middle * static_cast<double>(series.size() - 1);
}

std::vector<std::string> Leaks(const std::vector<ProcessUse>& after_rounds, int64_t memory_allowance_kib) {
  constexpr double kDescriptors = 2;
  std::vector<double> memory_kib;
  std::vector<double> descriptors;
  for (const ProcessUse& use : after_rounds) {
    memory_kib.push_back(static_cast<double>(use.resident_kib));
    descriptors.push_back(use.descriptors);
  }
  std::vector<std::string> leaks;
  if (const double growth = Growth(memory_kib); growth > static_cast<double>(memory_allowance_kib)) {
    leaks.push_back(fmt::format("the soak's own memory grew by {:.0f} MiB over the rounds", growth / 1024));
  }
  if (const double growth = Growth(descriptors); growth > kDescriptors) {
    leaks.push_back(fmt::format("the soak's own open descriptors grew by {:.0f} over the rounds", growth));
  }
  return leaks;
}

}  // namespace fresco
