#include "report/run_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <type_traits>

#include "core/identifier.h"
#include "report/result_display.h"

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
    description.success = names->success;
  }
  return description;
}

std::string ActorLine(const actor_status_t& status, const std::optional<learner_status_t>& learner) {
  const int32_t newest = NewestVersion(status);
  const std::string behind =
      !learner || newest < 0 ? "-" : fmt::format("{}", std::max(learner->current_version - newest, 0));
  return fmt::format("  {:<28} {:>13.0f} {:>9} {:>8} {:>10} {:>8} {:>11.1f}\n",
                     fmt::format("{}:{}", status.host, status.pid), status.transitions_per_s,
                     fmt::format("{}/{}", status.open_orders, status.capacity), behind,
                     status.resent_episodes, status.rejected_messages, status.weights_latency_ms);
}

}  // namespace

RunWatch::WatchedRun* RunWatch::RunOf(int64_t run_id) {
  const auto found = runs_.find(run_id);
  if (found != runs_.end()) {
    return &found->second;
  }
  return run_id == 0 || runs_.size() >= kMaximumRuns ? nullptr : &runs_[run_id];
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
      run->learner = message;
      run->heard_us = now_us;
    } else if constexpr (std::is_same_v<Message, world_t>) {
      run->world.Add(message);
    } else if constexpr (std::is_same_v<Message, weights_t>) {
      run->network_bytes += static_cast<int64_t>(event.message.size());
    } else if constexpr (std::is_same_v<Message, actor_status_t>) {
      if (run->actors.size() < kMaximumActors || run->actors.contains(message.actor_id)) {
        run->actors[message.actor_id] = {message, now_us};
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
                                 names == nullptr ? "" : fmt::format(", world {}", names->world));
  if (run.learner) {
    const learner_status_t& learner = *run.learner;
    const double silent_s = 1e-6 * static_cast<double>(now_us - run.heard_us);
    text += fmt::format("  {}{}\n", ProgressLine(learner, DescriptionOf(names)),
                        silent_s < 1 ? "" : fmt::format(" | not heard for {:.0f} s", silent_s));
    text += fmt::format(
        "  loss {:.4g} | learning rate {:.3g} | {} transitions in the replay memory | networks {} and {} | "
        "staleness "
        "{:.0f} updates\n",
        learner.loss, learner.learning_rate, learner.replay_size, learner.current_version,
        learner.target_version, learner.staleness_updates);
    text += fmt::format(
        "  received {} | asked for again {} | duplicate {} | rejected {} | networks sent {:.1f} kB/s\n",
        learner.received, learner.lost, learner.duplicate, learner.rejected,
        1e-3 * static_cast<double>(run.network_bytes) / seconds);
  } else {
    text += "  no learner heard\n";
  }
  text += fmt::format("  {:<28} {:>13} {:>9} {:>8} {:>10} {:>8} {:>11}\n", "actor", "transitions/s", "orders",
                      "behind", "sent again", "rejected", "network ms");
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
  text += fmt::format("{}{:.0f} messages/s on the bus, {} damaged\n", runs_.empty() ? "no run heard\n" : "",
                      static_cast<double>(messages_) / seconds, damaged_);
  messages_ = 0;
  since_us_ = now_us;
  return text;
}

}  // namespace fresco
