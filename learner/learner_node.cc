#include "learner/learner_node.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "core/identifier.h"
#include "msgs/protocol_times.h"
#include "msgs/world_messages.h"
#include "msgs/worlds.h"
#include "nn/mlp.h"

namespace fresco {
namespace {

constexpr int64_t kPollUs = 1'000;

}  // namespace

LearnerNode::LearnerNode(const Experiment& experiment, int64_t run_id, Bus& bus, const Channels& channels)
    : experiment_(experiment),
      bus_(bus),
      channels_(channels),
      identity_{run_id, experiment.hash()},
      total_episodes_(static_cast<int>(experiment.schedule().episodes())),
      ledger_(experiment_.world()),
      announcer_(experiment, run_id) {
  Subscribe(channels_.transitions, &LearnerNode::HandleTransitions);
  Subscribe(channels_.actor_status, &LearnerNode::HandleStatus);
  Subscribe(channels_.run, &LearnerNode::HandleRun);
}

template <class Message>
void LearnerNode::Subscribe(const std::string& channel, void (LearnerNode::*handle)(const Message&)) {
  bus_.Subscribe<Message>(channel, [this, handle](const Message& message) {
    const std::lock_guard lock(mutex_);
    (this->*handle)(message);
  });
}

void LearnerNode::WriteOrder(const Order& order) {
  const std::lock_guard lock(mutex_);
  ledger_.Write(order);
}

void LearnerNode::OfferVersion(NetworkVersion version, std::shared_ptr<const Vector> parameters) {
  const std::lock_guard lock(mutex_);
  publisher_.Offer(version, std::move(parameters));
}

void LearnerNode::Report(TrainingReport report) {
  const std::lock_guard lock(mutex_);
  report_ = std::move(report);
  report_.warning.resize(std::min(report_.warning.size(), kMaximumWarningBytes));
}

std::optional<CommittedEpisode> LearnerNode::WaitForNext(int64_t timeout_us) {
  std::unique_lock lock(mutex_);
  if (waiting_since_us_ == 0) {
    waiting_since_us_ = clock_.now_us();
  }
  next_is_complete_.wait_for(lock, std::chrono::microseconds(timeout_us), [this] {
    return ledger_.in_flight() > 0 && ledger_.IsComplete(ledger_.committed());
  });
  auto next = ledger_.TakeNext();
  if (next) {
    waiting_since_us_ = 0;
  }
  if (next && ledger_.in_flight() > 0) {
    const Order& oldest = ledger_.order(ledger_.committed());
    publisher_.Retain(oldest.current_version, oldest.target_version);
  }
  return next;
}

void LearnerNode::Reject(int64_t BusCounters::*cause) {
  ++counters_.rejected;
  ++(counters_.*cause);
}

bool LearnerNode::IsOurs(RunIdentity identity) {
  if (identity == identity_) {
    ++counters_.received;
    return true;
  }
  Reject(&BusCounters::rejected_foreign);
  return false;
}

void LearnerNode::HandleTransitions(const transitions_t& message) {
  if (!IsOurs(IdentityOf(message))) {
    return;
  }
  if (!FromWire(experiment_.world(), message, part_)) {
    return Reject(&BusCounters::rejected_malformed);
  }
  switch (ledger_.Add(part_)) {
    case Ledger::Arrival::kAccepted:
      return;
    case Ledger::Arrival::kDuplicate:
      ++counters_.duplicate;
      return;
    case Ledger::Arrival::kUnknownOrder:
      return Reject(&BusCounters::rejected_foreign);
    case Ledger::Arrival::kInconsistent:
      return Reject(&BusCounters::rejected_inconsistent);
    case Ledger::Arrival::kCompleted:
      break;
  }
  roster_.Completed(part_.order_index, message.actor_id, clock_.now_us());
  if (part_.order_index == ledger_.committed()) {
    next_is_complete_.notify_one();
  } else if (!ledger_.IsComplete(part_.order_index - 1)) {
    ++counters_.reordered_episodes;
  }
}

void LearnerNode::HandleStatus(const actor_status_t& message) {
  if (message.run_id == 0) {
    announcer_.Ask();
    return;
  }
  if (!IsOurs(IdentityOf(message))) {
    return;
  }
  if (message.arithmetic_fingerprint != ArithmeticFingerprint() || message.actor_id == 0) {
    return Reject(&BusCounters::rejected_arithmetic);
  }
  switch (roster_.Hear(message, clock_.now_us())) {
    case Roster::Hearing::kStale:
      ++counters_.stale_statuses;
      return;
    case Roster::Hearing::kCrowdedOut:
      ++counters_.crowded_statuses;
      return;
    case Roster::Hearing::kHeard:
      break;
  }
  for (const chunk_range_t& range : message.missing) {
    publisher_.Request(range, clock_.now_us());
  }
}

void LearnerNode::HandleRun(const run_t& message) {
  if (announcer_.IsForeign(message, channels_.run, WallMicroseconds())) {
    Reject(&BusCounters::rejected_foreign);
  }
}

void LearnerNode::Step() {
  const int64_t begin_us = MonotonicMicroseconds();
  int64_t now_us = 0;
  {
    const std::lock_guard lock(mutex_);
    now_us = clock_.Look(begin_us);
  }
  SendRun(now_us, false);
  SendWorldIfDue(now_us);
  SendOrders(now_us);
  SendWeights(now_us);
  SendStatusIfDue(now_us);
  const int64_t next_us = std::min({next_burst_us_, next_orders_us_, now_us + kPollUs});
  bus_.Poll(std::max<int64_t>(0, next_us - now_us - (MonotonicMicroseconds() - begin_us)));
}

void LearnerNode::SendRun(int64_t now_us, bool finished) {
  std::vector<run_t> messages;
  {
    const std::lock_guard lock(mutex_);
    if (finished || announcer_.IsDue(now_us)) {
      messages = announcer_.Messages(report_.progress, finished);
    }
  }
  for (run_t& message : messages) {
    bus_.Publish(channels_.run, message, identity_);
  }
}

void LearnerNode::SendWorldIfDue(int64_t now_us) {
  if (now_us >= next_world_us_) {
    next_world_us_ = now_us + kWorldPeriodUs;
    for (world_t& message : WorldMessages(experiment_.world())) {
      bus_.Publish(channels_.world, message, identity_);
    }
    for (scenario_t& message : ScenarioMessages(experiment_)) {
      bus_.Publish(channels_.scenario, message, identity_);
    }
  }
}

void LearnerNode::SendOrders(int64_t now_us) {
  if (now_us < next_orders_us_) {
    return;
  }
  next_orders_us_ = now_us + kNewOrdersPeriodUs;
  std::vector<order_t> due;
  orders_t message{};
  {
    const std::lock_guard lock(mutex_);
    due = roster_.DueOrders(ledger_, now_us);
    message.committed_orders = ledger_.committed();
  }
  for (size_t first = 0; first < due.size(); first += kMaximumOrdersPerMessage) {
    const size_t end = std::min(due.size(), first + kMaximumOrdersPerMessage);
    message.orders.assign(due.begin() + static_cast<int64_t>(first), due.begin() + static_cast<int64_t>(end));
    message.order_count = static_cast<int32_t>(message.orders.size());
    bus_.Publish(channels_.orders, message, identity_);
  }
}

void LearnerNode::SendWeights(int64_t now_us) {
  if (now_us < next_burst_us_) {
    return;
  }
  next_burst_us_ = now_us + kPollUs;  // if nothing is due
  for (int i = 0; i < kChunksPerBurst; ++i) {
    std::optional<std::pair<NetworkKind, weights_t>> chunk;
    {
      const std::lock_guard lock(mutex_);
      chunk = publisher_.Next(now_us);
    }
    if (!chunk) {
      return;
    }
    bus_.Publish(chunk->first == NetworkKind::kCurrent ? channels_.weights_current : channels_.weights_target,
                 chunk->second, identity_);
    next_burst_us_ = now_us + kChunkBurstPeriodUs;
  }
}

void LearnerNode::SendStatusIfDue(int64_t now_us) {
  if (now_us >= next_status_us_) {
    next_status_us_ = now_us + kLearnerStatusPeriodUs;
    bus_.Publish(channels_.learner_status, Status(now_us), identity_);
    WarnIfNeeded();
  }
}

learner_status_t LearnerNode::Status(int64_t now_us) {
  const std::lock_guard lock(mutex_);
  learner_status_t status{};
  report_.WriteTo(status);
  status.total_episodes = total_episodes_;
  status.transitions_per_s = transition_rate_.Measure(status.transitions, now_us);
  status.updates_per_s = update_rate_.Measure(status.updates, now_us);
  status.orders_in_flight = static_cast<int32_t>(ledger_.in_flight());
  status.actors = roster_.live_actors(now_us);
  const BusCounters counters = CountersLocked();
  status.received = counters.received;
  status.duplicate = counters.duplicate;
  status.rejected = counters.rejected;
  status.lost = counters.lost;
  status.reordered_episodes = counters.reordered_episodes;
  status.waiting_for = WaitingForLocked().substr(0, kMaximumWaitingForBytes);
  status.warning = report_.warning;
  return status;
}

void LearnerNode::WarnIfNeeded() {
  if (const std::string news = bus_.KeyMismatchNews(); !news.empty()) {
    spdlog::warn("{}", news);
  }
  if (const auto line = starvation_warning_.Note(StarvedSeconds(), WaitingFor())) {
    spdlog::warn("{}", *line);
  }
}

void LearnerNode::AnnounceEnd() {
  constexpr int kTimes = 3;  // against loss; an actor that misses all of them notices the silence
  for (int i = 0; i < kTimes; ++i) {
    SendRun(clock_.now_us(), true);
    bus_.Publish(channels_.learner_status, Status(clock_.now_us()), identity_);
    bus_.Poll(kPollUs);
  }
}

std::string LearnerNode::WaitingForLocked() const {
  if (!report_.finishing.empty()) {
    return report_.finishing;
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
  const bool starved = waiting_since_us_ != 0 && report_.finishing.empty() && ledger_.in_flight() > 0;
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

int64_t LearnerNode::ActorProcessorMicroseconds() const {
  const std::lock_guard lock(mutex_);
  return roster_.processor_us();
}

BusCounters LearnerNode::counters() const {
  const std::lock_guard lock(mutex_);
  return CountersLocked();
}

void LearnerNode::RestoreCounters(const BusCounters& counters) {
  const std::lock_guard lock(mutex_);
  counters_ = counters;
}

int64_t LearnerNode::foreign_run() const {
  const std::lock_guard lock(mutex_);
  return announcer_.foreign_run();
}

std::string LearnerNode::StateText() const {
  const std::lock_guard lock(mutex_);
  const TrainerProgress& progress = report_.progress;
  const BusCounters counters = CountersLocked();
  const std::string waiting_for = WaitingForLocked();
  std::string text = fmt::format(
      "state\n  run {}, configuration {:08x}\n  {} orders committed, {} in flight; {} of {} episodes, "
      "{} transitions, {} updates",
      IdentifierText(identity_.run_id), identity_.config_hash, ledger_.committed(), ledger_.in_flight(),
      progress.episodes, total_episodes_, progress.transitions, progress.updates);
  text += waiting_for.empty()
              ? "\n  waits for nobody"
              : fmt::format("\n  waits for {}; starved for {:.1f} s", waiting_for, StarvedSecondsLocked());
  text += report_.warning.empty() ? "" : "\n  warning: " + report_.warning;
  text += fmt::format("\n  networks on offer: {}; {} chunks sent, {} of them again", publisher_.StateText(),
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
