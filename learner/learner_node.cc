#include "learner/learner_node.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "core/clock.h"
#include "core/identifier.h"
#include "msgs/protocol_times.h"
#include "msgs/scenario_codec.h"

namespace fresco {
namespace {

constexpr int64_t kPollUs = 1'000;

}  // namespace

LearnerNode::LearnerNode(const Experiment& experiment, const World& world, int64_t run_id, Bus& bus,
                         const Channels& channels)
    : world_(&world),
      bus_(bus),
      channels_(channels),
      identity_{run_id, experiment.hash()},
      config_text_(experiment.Text()),
      total_episodes_(static_cast<int>(experiment.schedule().episodes())),
      ledger_(world, experiment.mask_options()) {
  const MlpShape shape = experiment.network_shape();
  announcement_.protocol_version = kProtocolVersion;
  announcement_.arithmetic_fingerprint = ArithmeticFingerprint();
  announcement_.inputs = shape.inputs();
  announcement_.outputs = shape.outputs();
  announcement_.parameters = static_cast<int32_t>(shape.parameter_count());
  announcement_.values_per_chunk = kValuesPerChunk;
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

void LearnerNode::OfferVersion(NetworkKind kind, int32_t version, std::shared_ptr<const Vector> parameters) {
  const std::lock_guard lock(mutex_);
  publisher_.Offer(kind, version, std::move(parameters));
}

void LearnerNode::SetProgress(const TrainerProgress& progress, const std::optional<Evaluation>& last,
                              const std::optional<BestNetwork>& best) {
  const std::lock_guard lock(mutex_);
  progress_ = progress;
  last_evaluation_ = last;
  if (best && best->evaluation.arrived) {
    best_evaluation_ = best->evaluation;
  }
}

void LearnerNode::SetOptimum(const OptimumBound& optimum) {
  const std::lock_guard lock(mutex_);
  optimum_ = optimum;
}

void LearnerNode::SetFinishing(const std::string& waiting_for) {
  const std::lock_guard lock(mutex_);
  finishing_ = waiting_for;
}

void LearnerNode::SetWarning(const std::string& warning) {
  const std::lock_guard lock(mutex_);
  warning_ = warning.substr(0, kMaximumWarningBytes);
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
  if (!FromWire(*world_, message, part_)) {
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
    run_was_asked_for_ = true;
    return;
  }
  if (!IsOurs(IdentityOf(message))) {
    return;
  }
  if (message.arithmetic_fingerprint != announcement_.arithmetic_fingerprint || message.actor_id == 0) {
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
  if (message.run_id == identity_.run_id && announced_) {
    return;
  }
  Reject(&BusCounters::rejected_foreign);
  if (message.finished != 0) {
    return;
  }
  const bool current = IsCurrent(message.utime, WallMicroseconds());
  bool& warned = current ? warned_of_foreign_run_ : warned_of_recorded_run_;
  if (!warned) {  // once: whoever floods the bus with runs is not to fill the log
    warned = true;
    spdlog::warn(
        "{}, {}, is on {}: it does no harm, but shares the bandwidth",
        current ? "another run" : "a recording of a run (or a run whose clock differs from this host's)",
        IdentifierText(message.run_id), channels_.run);
  }
  foreign_run_ = current ? message.run_id : foreign_run_;
}

void LearnerNode::Step() {
  const int64_t begin_us = MonotonicMicroseconds();
  int64_t now_us = 0;
  {
    const std::lock_guard lock(mutex_);
    now_us = clock_.Look(begin_us);
  }
  SendRunIfDue(now_us);
  SendScenarioIfDue(now_us);
  SendOrders(now_us);
  SendWeights(now_us);
  SendStatusIfDue(now_us);
  const int64_t next_us = std::min({next_burst_us_, next_orders_us_, now_us + kPollUs});
  bus_.Poll(std::max<int64_t>(0, next_us - now_us - (MonotonicMicroseconds() - begin_us)));
}

void LearnerNode::SendRunIfDue(int64_t now_us) {
  bool asked = false;
  {
    const std::lock_guard lock(mutex_);
    asked = run_was_asked_for_ && now_us >= next_run_us_ - kRunPeriodUs + kAskedRunPeriodUs;
    run_was_asked_for_ = run_was_asked_for_ && !asked;
  }
  if (asked || now_us >= next_run_us_) {
    next_run_us_ = now_us + kRunPeriodUs;
    SendRun(false);
  }
}

void LearnerNode::SendRun(bool finished) {
  {
    const std::lock_guard lock(mutex_);
    announced_ = true;
    announcement_.current_version = progress_.current_version;
    announcement_.target_version = progress_.target_version;
  }
  const int size = static_cast<int>(config_text_.size());
  announcement_.finished = finished ? 1 : 0;
  announcement_.part_count = (size + kMaximumPartBytes - 1) / kMaximumPartBytes;
  for (int part = 0; part < announcement_.part_count; ++part) {
    const std::string text =
        config_text_.substr(static_cast<size_t>(part) * kMaximumPartBytes, kMaximumPartBytes);
    announcement_.part_index = part;
    announcement_.part.assign(text.begin(), text.end());
    announcement_.part_size = static_cast<int32_t>(text.size());
    bus_.Publish(channels_.run, announcement_, identity_);
  }
}

void LearnerNode::SendScenarioIfDue(int64_t now_us) {
  if (now_us >= next_scenario_us_) {
    next_scenario_us_ = now_us + kScenarioPeriodUs;
    for (const scenario_t& message : ScenarioMessages(world_->scenario())) {
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
  next_burst_us_ = now_us + kPollUs;  // where nothing is due
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

void LearnerNode::WarnIfNeeded() {
  std::string foreign_key;
  {
    const std::lock_guard lock(mutex_);
    foreign_key = bus_.KeyMismatchNews();
  }
  if (!foreign_key.empty()) {
    spdlog::warn("{}", foreign_key);
  }
  if (const auto line = starvation_warning_.Note(StarvedSeconds(), WaitingFor())) {
    spdlog::warn("{}", *line);
  }
}

void LearnerNode::AnnounceEnd() {
  constexpr int kTimes = 3;  // against loss; an actor that misses all of them notices the silence
  for (int i = 0; i < kTimes; ++i) {
    SendRun(true);
    bus_.Publish(channels_.learner_status, Status(clock_.now_us()), identity_);
    bus_.Poll(kPollUs);
  }
}

int64_t LearnerNode::foreign_run() const {
  const std::lock_guard lock(mutex_);
  return foreign_run_;
}

}  // namespace fresco
