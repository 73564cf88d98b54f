#include "report/run_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>

#include "core/error.h"
#include "core/identifier.h"
#include "core/utf8.h"
#include "msgs/experiment.h"
#include "report/result_display.h"
#include "storage/judgement.h"
#include "training/schedules.h"

namespace fresco {
namespace {

constexpr int64_t kForgetUs = 10'000'000;

/// The newest version of the current network that the actor has; -1: none.
int32_t NewestVersion(const actor_status_t& status) {
  int32_t newest = -1;
  for (const chunk_range_t& held : status.held) {
    newest = held.network == 0 ? std::max(newest, held.version) : newest;
  }
  return newest;
}

/// What ProgressLine needs of a world.
WorldDescription DescriptionOf(const WorldNames* names) {
  WorldDescription description;
  description.figures = {{"score", ""}};
  description.success = "succeeded";
  if (names != nullptr) {
    description.figures = names->figures;
    for (Quantity& figure : description.figures) {
      figure = {Printable(figure.name), Printable(figure.unit)};
    }
    description.success = Printable(names->success);
  }
  return description;
}

std::string ActorLine(const actor_status_t& status, const std::optional<learner_status_t>& learner) {
  const int32_t newest = NewestVersion(status);
  const std::string behind =
      !learner || newest < 0
          ? "-"
          : fmt::format("{}", std::max<int64_t>(int64_t{learner->current_version} - newest, 0));
  return fmt::format("  {:<20} {:>13.0f} {:>8} {:>6} {:>6} {:>8} {:>10.1f}\n",
                     fmt::format("{}:{}", status.host, status.pid), status.transitions_per_s,
                     fmt::format("{}/{}", status.open_orders, status.capacity), behind,
                     status.resent_episodes, status.rejected_messages, status.weights_latency_ms);
}

/// The mean scores of the world's reference policies in the episodes that judge the run: "AoI-based 17.543".
/// Empty if the world has none, if these episodes are not known or would take long, or if the world's code is
/// not Fresco's.
std::string ReferenceScores(const std::string& configuration) {
  constexpr char kOrigin[] = "the run's configuration";
  constexpr int64_t kMostTransitions =
      100'000;  // whoever sends a configuration is not to keep this program busy
  if (!Experiment::CodeIn(configuration, kOrigin).empty()) {
    return "";
  }
  const Experiment experiment = Experiment::Parse(configuration, kOrigin);
  const World& world = experiment.world();
  std::vector<uint64_t> seeds = {0};
  if (world.description().random) {
    const int64_t episodes = experiment.schedule().evaluation_episodes();
    if (!experiment.schedule().fixed_evaluation_episodes() ||
        episodes * world.longest_episode() > kMostTransitions) {
      return "";
    }
    seeds = FixedEvaluationSeeds(experiment.schedule());
  }
  std::string text;
  for (const ReferencePolicy& policy : world.reference_policies()) {
    PolicyFigures figures;
    for (const uint64_t seed : seeds) {
      figures.Add(world, world.FlyReference(policy.name, seed));
    }
    text += fmt::format("{}{} {:.3f}", text.empty() ? "" : ", ", policy.title, figures.Means().front());
  }
  return text;
}

/// What is no learner's, but sent by somebody else, must not fill the terminal.
template <class Number>
void MakeShowable(Number& value) {
  constexpr Number kLargest = 1e12F;
  value = std::abs(value) < kLargest ? value : std::numeric_limits<Number>::quiet_NaN();
}
void MakeShowable(learner_status_t& status) {
  for (double* value : {&status.epsilon, &status.learning_rate, &status.loss, &status.score, &status.success,
                        &status.best_score, &status.score_bound, &status.gap_percent,
                        &status.gap_median_percent, &status.gap_worst_percent, &status.staleness_updates,
                        &status.transitions_per_s, &status.updates_per_s}) {
    MakeShowable(*value);
  }
  status.waiting_for = Printable(status.waiting_for);
  status.warning = Printable(status.warning);
}

/// The parts of a text "a | b | c" as lines of a terminal of 80 columns, each indented.
std::string Wrapped(const std::string& text) {
  constexpr size_t kColumns = 78;
  constexpr std::string_view kBetween = " | ";
  std::string lines;
  std::string line;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(kBetween, begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + kBetween.size();
    if (!line.empty() && line.size() + kBetween.size() + part.size() > kColumns) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "  " : std::string(kBetween)) + part;
  }
  return lines + line + "\n";
}

/// "[######              ]"
std::string ProgressBar(double share) {
  constexpr size_t kColumns = 30;
  const auto done = static_cast<size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(kColumns));
  return "[" + std::string(done, '#') + std::string(kColumns - done, ' ') + "]";
}

}  // namespace

std::vector<std::string> RunWatch::NeededChannels() const {
  return {channels_.run, channels_.world, channels_.learner_status, channels_.actor_status};
}

void RunWatch::AddStatus(learner_status_t status, int64_t now_us, WatchedRun& run) {
  MakeShowable(status);
  if (!run.learner) {
    run.time_left_estimate = {};
  }
  run.time_left = run.time_left_estimate.Report(static_cast<double>(status.episodes),
                                                static_cast<double>(status.total_episodes), now_us);
  const auto updates = static_cast<double>(status.updates);
  if (status.updates >= 0 && std::isfinite(status.score) && std::isfinite(status.best_score)) {
    // A run that was resumed has gone back.
    std::erase_if(run.evaluations, [&](const TextCurvePoint& point) { return point.updates >= updates; });
    if (run.evaluations.empty() || run.evaluations.back().score != status.score) {
      run.evaluations.push_back({updates, status.score, status.best_score});
    }
  }
  if (run.evaluations.size() > kMaximumEvaluations) {  // keep every second one
    size_t kept = 0;
    for (size_t i = 0; i < run.evaluations.size(); i += 2) {
      run.evaluations[kept++] = run.evaluations[i];
    }
    run.evaluations.resize(kept);
  }
  run.learner = status;
  run.heard_us = now_us;
}

void RunWatch::AddAnnouncement(const run_t& message, WatchedRun& run) {
  if (!run.announced) {
    if (const std::optional<std::string> configuration = run.announcements.Add(message)) {
      run.announced = true;
      try {
        run.references = ReferenceScores(*configuration);
      } catch (const Error&) {
        // A configuration that this program can't use: the learner's scores stand alone.
      }
    }
  }
}

RunWatch::WatchedRun* RunWatch::RunOf(int64_t run_id) {
  const auto found = runs_.find(run_id);
  if (found != runs_.end()) {
    return &found->second;
  }
  const bool unwanted = run_id == 0 || (only_run_ && run_id != *only_run_);
  return unwanted || runs_.size() >= kMaximumRuns ? nullptr : &runs_[run_id];
}

void RunWatch::Add(const LcmEvent& event, int64_t now_us) {
  since_us_ = since_us_.value_or(now_us);
  ++messages_;
  if (event.channel == channels_.transitions || event.channel == channels_.orders) {
    return;  // most of the traffic; statuses sum it up
  }
  const auto result = decoder_.Decode(event.message, [&](const auto& message) {
    using Message = std::remove_cvref_t<decltype(message)>;
    WatchedRun* run = RunOf(message.run_id);
    if (run == nullptr) {
      return;
    }
    if constexpr (std::is_same_v<Message, learner_status_t>) {
      AddStatus(message, now_us, *run);
    } else if constexpr (std::is_same_v<Message, run_t>) {
      AddAnnouncement(message, *run);
    } else if constexpr (std::is_same_v<Message, world_t>) {
      run->world.Add(message);
    } else if constexpr (std::is_same_v<Message, weights_t>) {
      run->network_bytes += static_cast<int64_t>(event.message.size());
    } else if constexpr (std::is_same_v<Message, actor_status_t>) {
      if (run->actors.size() < kMaximumActors || run->actors.contains(message.actor_id)) {
        WatchedActor& actor = run->actors[message.actor_id] = {message, now_us};
        actor.status.host = Printable(message.host);
        MakeShowable(actor.status.transitions_per_s);
        MakeShowable(actor.status.weights_latency_ms);
      }
    }
  });
  damaged_ += result == MessageDecoder::Result::kDamaged ? 1 : 0;
}

bool RunWatch::HasRun() const {
  return std::any_of(runs_.begin(), runs_.end(),
                     [](const auto& run) { return run.second.learner.has_value(); });
}

void RunWatch::Forget(int64_t now_us) {
  for (auto& [run_id, run] : runs_) {
    std::erase_if(run.actors, [&](const auto& actor) { return now_us - actor.second.heard_us > kForgetUs; });
    if (now_us - run.heard_us > kForgetUs) {
      run.learner.reset();
    }
  }
  std::erase_if(runs_, [](const auto& run) { return !run.second.learner && run.second.actors.empty(); });
}

std::string RunWatch::TextOf(int64_t run_id, const WatchedRun& run, double seconds, int64_t now_us) const {
  const WorldNames* names = run.world.names();
  std::string text = fmt::format("run {}{}\n", IdentifierText(run_id),
                                 names == nullptr ? "" : fmt::format(", world {}", Printable(names->world)));
  if (run.learner) {
    const learner_status_t& learner = *run.learner;
    const double share = static_cast<double>(learner.episodes) /
                         static_cast<double>(std::max<int64_t>(learner.total_episodes, 1));
    text += fmt::format("  {} {}\n", ProgressBar(share), run.time_left);
    const double silent_s = 1e-6 * static_cast<double>(now_us - run.heard_us);
    std::string progress = ProgressLine(learner, DescriptionOf(names));
    if (silent_s >= 1) {
      progress += fmt::format(" | not heard for {:.0f} s", silent_s);
    }
    if (!run.references.empty()) {
      progress += " | for comparison: " + run.references;
    }
    text += Wrapped(progress);
    text += Wrapped(fmt::format(
        "loss {:.4g} | learning rate {:.3g} | {} transitions in the replay memory | networks {} and {} | "
        "staleness {:.0f} updates",
        learner.loss, learner.learning_rate, learner.replay_size, learner.current_version,
        learner.target_version, learner.staleness_updates));
    std::string traffic = fmt::format("received {} | asked for again {} | duplicate {} | rejected {}",
                                      learner.received, learner.lost, learner.duplicate, learner.rejected);
    if (!only_run_) {
      traffic += fmt::format(" | networks sent {:.1f} kB/s",
                             1e-3 * static_cast<double>(run.network_bytes) / seconds);
    }
    text += Wrapped(traffic);
    if (run.evaluations.size() > 1) {
      TextCurve curve{.title = "  " + Label(DescriptionOf(names).figures.front()) +
                               ": * best so far, . evaluations" +
                               (learner.optimum_proved != 0 ? ", - exact optimum" : ""),
                      .points = run.evaluations};
      if (learner.optimum_proved != 0 && std::isfinite(learner.score_bound)) {
        curve.optimum = learner.score_bound;
      }
      text += Draw(curve);
    }
  } else {
    text += "  no learner heard\n";
  }
  text += fmt::format("  {:<20} {:>13} {:>8} {:>6} {:>6} {:>8} {:>10}\n", "actor", "transitions/s", "orders",
                      "behind", "resent", "rejected", "network ms");
  for (const auto& [actor_id, actor] : run.actors) {
    text += ActorLine(actor.status, run.learner);
  }
  return text;
}

std::string RunWatch::Text(int64_t now_us) {
  Forget(now_us);
  const double seconds = std::max(1e-6 * static_cast<double>(now_us - since_us_.value_or(now_us)), 1e-3);
  std::string text;
  for (auto& [run_id, run] : runs_) {
    text += TextOf(run_id, run, seconds, now_us) + "\n";
    run.network_bytes = 0;
  }
  if (only_run_) {
    return text;
  }
  text += fmt::format("{}{:.0f} messages/s on the bus, {} damaged\n", runs_.empty() ? "no run heard\n" : "",
                      static_cast<double>(messages_) / seconds, damaged_);
  messages_ = 0;
  since_us_ = now_us;
  return text;
}

}  // namespace fresco
