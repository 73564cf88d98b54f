#include "soak/soak_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// How runs recovered from the faults of one kind.
struct Recovery {
  int64_t faults = 0;
  int64_t recovered = 0;
  double sum_s = 0;
  double longest_s = 0;

  double mean_s() const { return recovered == 0 ? 0 : sum_s / static_cast<double>(recovered); }
};

Recovery RecoveryFrom(FaultKind kind, const SoakReport& report) {
  Recovery recovery;
  for (const SoakRoundReport& round : report.rounds) {
    for (const InjectedFault& fault : round.result.faults) {
      if (fault.fault.kind != kind) {
        continue;
      }
      ++recovery.faults;
      if (fault.recovery_s) {
        ++recovery.recovered;
        recovery.sum_s += *fault.recovery_s;
        recovery.longest_s = std::max(recovery.longest_s, *fault.recovery_s);
      }
    }
  }
  return recovery;
}

UseByProgram UseInRounds(const SoakReport& report) {
  UseByProgram maxima;
  for (const SoakRoundReport& round : report.rounds) {
    Include(round.result.use, maxima);
  }
  return maxima;
}

std::string Verdict(const SoakReport& report) {
  const bool failed = !report.passed() && !report.interrupted;
  return failed ? "failed" : report.interrupted ? "interrupted" : "equal";
}

std::string WeightsOf(const RoundResult& result) {
  return result.facts ? result.facts->weights_crc32c : "-";
}

int64_t LostTransitions(const SoakReport& report, const RoundResult& result) {
  return report.undisturbed.facts && result.facts
             ? report.undisturbed.facts->transitions - result.facts->transitions
             : 0;
}

// ---- Text.

std::string RoundTable(const SoakReport& report) {
  std::string text = fmt::format("  {:<12}{:>8}{:>8}{:>10}{:>14}  {}\n", "round", "wall s", "faults",
                                 "resumed", "longest gap s", "weights");
  const auto line = [&](const std::string& name, const RoundResult& result, const std::string& word) {
    text +=
        fmt::format("  {:<12}{:>8.1f}{:>8}{:>10}{:>14.2f}  {}{}\n", name, result.wall_s, result.faults.size(),
                    result.resumptions, result.longest_pause_s, WeightsOf(result), word);
  };
  line("undisturbed", report.undisturbed, "");
  for (const SoakRoundReport& round : report.rounds) {
    line(std::to_string(round.number), round.result,
         !round.result.failures.empty() ? "  FAILED"
         : round.result.facts           ? "  equal"
                                        : "  not compared");
  }
  return text;
}

std::string RecoveryTable(const SoakReport& report) {
  std::string text =
      fmt::format("  {:<16}{:>8}{:>18}{:>14}\n", "fault", "number", "recovery: mean s", "longest s");
  for (const FaultKind kind : kFaultKinds) {
    const Recovery recovery = RecoveryFrom(kind, report);
    text += fmt::format("  {:<16}{:>8}{:>18.2f}{:>14.2f}\n", FaultKindName(kind), recovery.faults,
                        recovery.mean_s(), recovery.longest_s);
  }
  return text;
}

std::string UseTable(const SoakReport& report) {
  std::string text = fmt::format("  {:<16}{:>14}{:>10}{:>16}{:>10}\n", "process (most)", "undisturbed MiB",
                                 "rounds", "undisturbed fds", "rounds");
  const UseByProgram rounds = UseInRounds(report);
  for (const auto& [program, use] : report.undisturbed.use) {
    const auto found = rounds.find(program);
    const ProcessUse most = found == rounds.end() ? ProcessUse{} : found->second;
    text += fmt::format("  {:<16}{:>15.1f}{:>10.1f}{:>16}{:>10}\n", program,
                        static_cast<double>(use.peak_kib) / 1024, static_cast<double>(most.peak_kib) / 1024,
                        use.descriptors, most.descriptors);
  }
  return text;
}

std::string FailureText(const SoakReport& report) {
  std::string text;
  for (const std::string& failure : report.failures) {
    text += fmt::format("  {}\n", failure);
  }
  for (const SoakRoundReport& round : report.rounds) {
    for (const std::string& failure : round.result.failures) {
      text += fmt::format("  round {}: {}\n", round.number, failure);
    }
    if (!round.result.failures.empty()) {
      text += fmt::format("    again: {}\n", round.repeat);
    }
  }
  return text;
}

// ---- JSON.

OrderedJson JsonOf(const RoundResult& result) {
  OrderedJson json;
  json["wall_s"] = result.wall_s;
  json["complete"] = result.facts.has_value();
  json["weights_crc32c"] = result.facts ? OrderedJson(result.facts->weights_crc32c) : OrderedJson();
  json["transitions"] = result.facts ? OrderedJson(result.facts->transitions) : OrderedJson();
  json["updates"] = result.facts ? OrderedJson(result.facts->updates) : OrderedJson();
  json["faults"] = result.faults.size();
  json["resumptions"] = result.resumptions;
  json["longest_gap_s"] = result.longest_pause_s;
  json["failures"] = result.failures;
  return json;
}

OrderedJson JsonOf(const SoakReport& report, const SoakRoundReport& round) {
  OrderedJson json = {{"round", round.number}, {"disturbance", round.disturbance}};
  json.update(JsonOf(round.result));
  json["transitions_lost"] = LostTransitions(report, round.result);
  json["repeat"] = round.repeat;
  return json;
}

OrderedJson JsonOf(const UseByProgram& use) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [program, figures] : use) {
    json[program] = {{"peak_kib", figures.peak_kib}, {"descriptors", figures.descriptors}};
  }
  return json;
}

}  // namespace

bool SoakReport::passed() const {
  const auto good = [](const SoakRoundReport& round) {
    return round.result.facts && round.result.failures.empty();
  };
  return !interrupted && failures.empty() && !rounds.empty() &&
         std::all_of(rounds.begin(), rounds.end(), good);
}

std::string SoakText(const SoakReport& report) {
  return fmt::format("{}\n{}\n{}\nseed {}, {:.0f} s in all; verdict: {}\n{}", RoundTable(report),
                     RecoveryTable(report), UseTable(report), report.seed, report.wall_s, Verdict(report),
                     FailureText(report));
}

std::string SoakJson(const SoakReport& report) {
  OrderedJson json;
  json["verdict"] = Verdict(report);
  json["failures"] = report.failures;
  json["seed"] = report.seed;
  json["folder"] = report.folder.string();
  json["wall_s"] = report.wall_s;
  json["undisturbed"] = JsonOf(report.undisturbed);
  json["rounds"] = OrderedJson::array();
  int64_t lost = 0;
  for (const SoakRoundReport& round : report.rounds) {
    json["rounds"].push_back(JsonOf(report, round));
    lost += LostTransitions(report, round.result);
  }
  json["transitions_lost"] = lost;
  for (const FaultKind kind : kFaultKinds) {
    const Recovery recovery = RecoveryFrom(kind, report);
    json["faults"][FaultKindName(kind)] = {{"number", recovery.faults},
                                           {"recovered", recovery.recovered},
                                           {"mean_recovery_s", recovery.mean_s()},
                                           {"longest_recovery_s", recovery.longest_s}};
  }
  json["use"] = {{"undisturbed", JsonOf(report.undisturbed.use)}, {"rounds", JsonOf(UseInRounds(report))}};
  return json.dump(2);
}

std::vector<std::string> FaultHeader() {
  return {"utime", "round", "at_s", "kind", "actor", "duration_s", "recovery_s"};
}

std::vector<std::vector<CsvCell>> FaultRows(const SoakReport& report) {
  std::vector<std::vector<CsvCell>> rows;
  for (const SoakRoundReport& round : report.rounds) {
    for (const InjectedFault& injected : round.result.faults) {
      const Fault& fault = injected.fault;
      rows.push_back({injected.wall_us, int64_t{round.number}, 1e-6 * static_cast<double>(fault.at_us),
                      std::string(FaultKindName(fault.kind)), int64_t{fault.actor},
                      1e-6 * static_cast<double>(fault.duration_us),
                      injected.recovery_s ? CsvCell(*injected.recovery_s) : CsvCell(std::string())});
    }
  }
  return rows;
}

}  // namespace fresco
