#include "tools/train_display.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace fresco {
namespace {

size_t TerminalWidth() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string Row(const std::string& name, const nlohmann::json& figures) {
  if (figures.value("average_aoi", nlohmann::json()).is_null()) {
    return fmt::format("  {:<16} {:>12} {:>10}  {}\n", name, "-", "-", "not evaluated");
  }
  return fmt::format("  {:<16} {:>12.3f} {:>10}  {}\n", name, figures.at("average_aoi").get<double>(),
                     figures.at("total_aoi").get<int64_t>(),
                     figures.at("arrived").get<bool>() ? "yes" : "NO");
}

}  // namespace

std::string ProgressLine(const learner_status_t& status) {
  const double percent = 100.0 * static_cast<double>(status.episodes) /
                         static_cast<double>(std::max<int64_t>(1, status.total_episodes));
  const std::string aoi =
      std::isnan(status.average_aoi)
          ? "-"
          : fmt::format("{:.3f}{}", status.average_aoi, status.arrived != 0 ? "" : " (not arrived)");
  return fmt::format(
      "{:3.0f}% | {} of {} episodes | {} updates | epsilon {:.3f} | greedy AoI {} | {:.0f} transitions/s | "
      "{:.0f} updates/s | {} actors{}",
      percent, status.episodes, status.total_episodes, status.updates, status.epsilon, aoi,
      status.transitions_per_s, status.updates_per_s, status.actors,
      status.waiting_for.empty() ? " | actors wait for the learner"
                                 : " | learner waits for " + status.waiting_for);
}

ProgressDisplay::ProgressDisplay(bool enabled) : enabled_(enabled), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() {
  Finish();
}

void ProgressDisplay::Show(const learner_status_t& status, int64_t now_us) {
  constexpr int64_t kPlainPeriodUs = 5'000'000;
  if (!enabled_ || (!terminal_ && now_us < next_us_)) {
    return;
  }
  next_us_ = now_us + kPlainPeriodUs;
  const std::string line = ProgressLine(status);
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[K{}", line.substr(0, TerminalWidth() - 1));
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
}

void ProgressDisplay::Finish() {
  if (line_open_) {
    fmt::print(stderr, "\n");
    line_open_ = false;
  }
}

std::string ResultTable(const std::string& summary_json) {
  const auto summary = nlohmann::json::parse(summary_json);
  std::string table =
      fmt::format("  {:<16} {:>12} {:>10}  {}\n", "policy", "average AoI", "total AoI", "arrived");
  table += Row("this run (DQN)", summary);
  table += Row("AoI-based", summary.at("baselines").at("aoi"));
  table += Row("distance-based", summary.at("baselines").at("distance"));
  return table;
}

}  // namespace fresco
