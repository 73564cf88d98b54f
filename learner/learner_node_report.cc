// What the learner's side of the bus tells people: status, whom it waits for, state.
#include <fmt/format.h>

#include <limits>

#include "core/identifier.h"
#include "learner/learner_node.h"

namespace fresco {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double OrNan(const std::optional<Evaluation>& evaluation) {
  return evaluation ? evaluation->figures.average_aoi : kNan;
}

}  // namespace

void LearnerNode::MeasureRates(int64_t now_us) {
  constexpr int64_t kRatePeriodUs = 1'000'000;
  if (now_us - rate_since_us_ >= kRatePeriodUs) {
    const double seconds = static_cast<double>(now_us - rate_since_us_) * 1e-6;
    transitions_per_s_ = static_cast<double>(progress_.transitions - rate_from_.transitions) / seconds;
    updates_per_s_ = static_cast<double>(progress_.updates - rate_from_.updates) / seconds;
    rate_since_us_ = now_us;
    rate_from_ = progress_;
  }
}

void LearnerNode::AddEvaluations(learner_status_t& status) const {
  status.average_aoi = OrNan(last_evaluation_);
  status.best_average_aoi = OrNan(best_evaluation_);
  status.arrived = last_evaluation_ && last_evaluation_->arrived ? 1 : 0;
  status.lower_bound_average_aoi = optimum_ ? optimum_->lower_bound_average_aoi : kNan;
  status.optimum_proved = optimum_ && optimum_->proved ? 1 : 0;
  status.gap_percent = status.optimum_proved != 0
                           ? GapPercent(status.best_average_aoi, optimum_->lower_bound_average_aoi)
                           : kNan;
}

learner_status_t LearnerNode::Status(int64_t now_us) {
  const std::lock_guard lock(mutex_);
  MeasureRates(now_us);
  learner_status_t status{};
  status.committed_orders = progress_.committed_orders;
  status.episodes = progress_.episodes;
  status.total_episodes = total_episodes_;
  status.transitions = progress_.transitions;
  status.updates = progress_.updates;
  status.replay_size = progress_.replay_size;
  status.current_version = progress_.current_version;
  status.target_version = progress_.target_version;
  status.orders_in_flight = static_cast<int32_t>(ledger_.in_flight());
  status.actors = roster_.live_actors(now_us);
  status.epsilon = progress_.epsilon;
  status.learning_rate = progress_.learning_rate;
  status.loss = progress_.loss;
  AddEvaluations(status);
  status.staleness_updates = progress_.staleness_updates;
  status.transitions_per_s = transitions_per_s_;
  status.updates_per_s = updates_per_s_;
  const BusCounters counters = CountersLocked();
  status.received = counters.received;
  status.duplicate = counters.duplicate;
  status.rejected = counters.rejected;
  status.lost = counters.lost;
  status.reordered_episodes = counters.reordered_episodes;
  status.waiting_for = WaitingForLocked().substr(0, kMaximumWaitingForBytes);
  status.warning = warning_;
  return status;
}

std::string LearnerNode::WaitingForLocked() const {
  if (!finishing_.empty()) {
    return finishing_;
  }
  if (waiting_since_us_ == 0 || ledger_.in_flight() == 0 || ledger_.IsComplete(ledger_.committed())) {
    return "";
  }
  const std::string awaited = roster_.Awaited(ledger_.order(ledger_.committed()), clock_.now_us());
  const std::string reason = roster_.live_actors(clock_.now_us()) == 0 ? bus_.KeyMismatch() : "";
  return reason.empty() ? awaited : fmt::format("{} ({})", awaited, reason);
}

std::string LearnerNode::WaitingFor() const {
  const std::lock_guard lock(mutex_);
  return WaitingForLocked();
}

double LearnerNode::StarvedSecondsLocked() const {
  const bool starved = waiting_since_us_ != 0 && finishing_.empty() && ledger_.in_flight() > 0;
  return starved ? static_cast<double>(clock_.now_us() - waiting_since_us_) * 1e-6 : 0;
}

double LearnerNode::StarvedSeconds() const {
  const std::lock_guard lock(mutex_);
  return StarvedSecondsLocked();
}

BusCounters LearnerNode::CountersLocked() const {
  BusCounters counters = counters_;
  counters.lost += roster_.late_orders();
  counters.weights_chunks_sent += publisher_.sent_chunks();
  counters.weights_chunks_repeated += publisher_.repeated_chunks();
  counters.rejected_malformed += bus_.malformed_messages();
  counters.rejected_unauthenticated += bus_.unauthenticated_messages();
  counters.rejected += bus_.malformed_messages() + bus_.unauthenticated_messages();
  return counters;
}

BusCounters LearnerNode::counters() const {
  const std::lock_guard lock(mutex_);
  return CountersLocked();
}

void LearnerNode::RestoreCounters(const BusCounters& counters) {
  const std::lock_guard lock(mutex_);
  counters_ = counters;
}

std::string LearnerNode::StateText() const {
  const std::lock_guard lock(mutex_);
  const BusCounters counters = CountersLocked();
  const std::string waiting_for = WaitingForLocked();
  std::string text = fmt::format(
      "state\n  run {}, configuration {:08x}\n  {} orders committed, {} in flight; {} of {} episodes, "
      "{} transitions, {} updates",
      IdentifierText(identity_.run_id), identity_.config_hash, ledger_.committed(), ledger_.in_flight(),
      progress_.episodes, total_episodes_, progress_.transitions, progress_.updates);
  text += waiting_for.empty()
              ? "\n  waits for nobody"
              : fmt::format("\n  waits for {}; starved for {:.1f} s", waiting_for, StarvedSecondsLocked());
  text += warning_.empty() ? "" : "\n  warning: " + warning_;
  text += fmt::format("\n  networks on offer: {}; {} chunks sent, {} of them again", publisher_.Offered(),
                      counters.weights_chunks_sent, counters.weights_chunks_repeated);
  text += fmt::format(
      "\n  messages: {} received, {} duplicate, {} rejected, {} stale and {} crowded statuses; {} orders "
      "asked "
      "for again, {} episodes out of order",
      counters.received, counters.duplicate, counters.rejected, counters.stale_statuses,
      counters.crowded_statuses, counters.lost, counters.reordered_episodes);
  return text + fmt::format("\n  {} actors", roster_.live_actors(clock_.now_us())) +
         roster_.StateText(clock_.now_us());
}

}  // namespace fresco
