#include "learner/learner_node.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "core/clock.h"

namespace fresco {
namespace {

constexpr int64_t kRunPeriodUs = 500'000;
constexpr int64_t kAskedRunPeriodUs = 50'000;
constexpr int64_t kOrdersPeriodUs = 2'000;
constexpr int64_t kStatusPeriodUs = 200'000;
constexpr int64_t kPollUs = 1'000;
// Pacing: 8 chunks, then 0.2 ms, is complete even on Linux's default socket buffers.
constexpr int kChunksPerBurst = 8;
constexpr int64_t kBurstPeriodUs = 200;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double OrNan(const std::optional<Evaluation>& evaluation) {
  return evaluation ? evaluation->figures.average_aoi : kNan;
}

}  // namespace

LearnerNode::LearnerNode(const Experiment& experiment, const World& world, int64_t run_id, Bus& bus,
                         const Channels& channels)
    : world_(&world),
      bus_(&bus),
      channels_(channels),
      identity_{run_id, experiment.hash()},
      config_text_(experiment.Text()),
      total_episodes_(static_cast<int>(experiment.schedule().episodes())),
      ledger_(world, experiment.mask_options()),
      key_mismatch_(bus) {
  const MlpShape shape = experiment.network_shape();
  announcement_.protocol_version = kProtocolVersion;
  announcement_.arithmetic_fingerprint = ArithmeticFingerprint();
  announcement_.inputs = shape.inputs();
  announcement_.outputs = shape.outputs();
  announcement_.parameters = static_cast<int32_t>(shape.parameter_count());
  announcement_.values_per_chunk = kValuesPerChunk;
  Subscribe<transitions_t>(channels_.transitions,
                           [this](const auto& message) { HandleTransitions(message); });
  Subscribe<actor_status_t>(channels_.actor_status, [this](const auto& message) { HandleStatus(message); });
  Subscribe<run_t>(channels_.run, [this](const auto& message) { HandleRun(message); });
}

template <class Message, class Handler>
void LearnerNode::Subscribe(const std::string& channel, Handler handler) {
  auto message = std::make_shared<Message>();
  bus_->Subscribe(channel, [this, handler, message](std::span<const std::byte> bytes) {
    const bool decoded = Decode(bytes, *message);
    const std::lock_guard lock(mutex_);
    if (decoded) {
      handler(*message);
    } else {
      Reject(&BusCounters::rejected_malformed);
      key_mismatch_.Note(bytes);
    }
  });
}

template <class Message>
void LearnerNode::Publish(const std::string& channel, Message message) {
  Stamp(message, identity_, WallMicroseconds());
  Encode(message, bytes_);
  bus_->Publish(channel, bytes_);
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

std::optional<CommittedEpisode> LearnerNode::WaitForNext(int64_t timeout_us) {
  std::unique_lock lock(mutex_);
  trainer_waits_ = true;
  next_is_complete_.wait_for(lock, std::chrono::microseconds(timeout_us), [this] {
    return ledger_.in_flight() > 0 && ledger_.IsComplete(ledger_.committed());
  });
  auto next = ledger_.TakeNext();
  trainer_waits_ = !next.has_value();
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
  if (!ToEpisodeRun(*world_, message, run_)) {
    return Reject(&BusCounters::rejected_malformed);
  }
  switch (ledger_.Add(run_)) {
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
  roster_.Completed(run_.order_index, MonotonicMicroseconds());
  if (run_.order_index == ledger_.committed()) {
    next_is_complete_.notify_one();
  } else if (!ledger_.IsComplete(run_.order_index - 1)) {
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
  const int64_t now_us = MonotonicMicroseconds();
  roster_.Hear(message, now_us);
  for (const chunk_range_t& range : message.missing) {
    publisher_.Request(range, now_us);
  }
}

void LearnerNode::HandleRun(const run_t& message) {
  const bool own = message.run_id == identity_.run_id && announced_;
  if (!own && message.finished == 0) {
    if (foreign_run_ != message.run_id) {
      spdlog::warn("another run, {:016x}, is on {}: it does no harm, but shares the bandwidth",
                   static_cast<uint64_t>(message.run_id), channels_.run);
    }
    foreign_run_ = message.run_id;
  }
}

void LearnerNode::Step() {
  const int64_t begin_us = MonotonicMicroseconds();
  SendRunIfDue(begin_us);
  SendOrders(begin_us);
  SendWeights(begin_us);
  SendStatusIfDue(begin_us);
  const int64_t next_us = std::min({next_burst_us_, next_orders_us_, begin_us + kPollUs});
  bus_->Poll(std::max<int64_t>(0, next_us - MonotonicMicroseconds()));
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
    Publish(channels_.run, announcement_);
  }
}

void LearnerNode::SendOrders(int64_t now_us) {
  if (now_us < next_orders_us_) {
    return;
  }
  next_orders_us_ = now_us + kOrdersPeriodUs;
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
    Publish(channels_.orders, message);
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
    Publish(chunk->first == NetworkKind::kCurrent ? channels_.weights_current : channels_.weights_target,
            chunk->second);
    next_burst_us_ = now_us + kBurstPeriodUs;
  }
}

void LearnerNode::SendStatusIfDue(int64_t now_us) {
  if (now_us >= next_status_us_) {
    next_status_us_ = now_us + kStatusPeriodUs;
    Publish(channels_.learner_status, Status(now_us));
    const std::lock_guard lock(mutex_);
    if (const std::string news = key_mismatch_.News(); !news.empty()) {
      spdlog::warn("{}", news);
    }
  }
}

learner_status_t LearnerNode::Status(int64_t now_us) {
  const std::lock_guard lock(mutex_);
  constexpr int64_t kRatePeriodUs = 1'000'000;
  if (now_us - rate_since_us_ >= kRatePeriodUs) {
    const double seconds = static_cast<double>(now_us - rate_since_us_) * 1e-6;
    transitions_per_s_ = static_cast<double>(progress_.transitions - rate_from_.transitions) / seconds;
    updates_per_s_ = static_cast<double>(progress_.updates - rate_from_.updates) / seconds;
    rate_since_us_ = now_us;
    rate_from_ = progress_;
  }
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
  status.actors = roster_.live_actors();
  status.epsilon = progress_.epsilon;
  status.learning_rate = progress_.learning_rate;
  status.loss = progress_.loss;
  status.average_aoi = OrNan(last_evaluation_);
  status.best_average_aoi = OrNan(best_evaluation_);
  status.arrived = last_evaluation_ && last_evaluation_->arrived ? 1 : 0;
  status.lower_bound_average_aoi = optimum_ ? optimum_->lower_bound_average_aoi : kNan;
  status.optimum_proved = optimum_ && optimum_->proved ? 1 : 0;
  status.gap_percent =
      optimum_ ? GapPercent(status.best_average_aoi, optimum_->lower_bound_average_aoi) : kNan;
  status.staleness_updates = progress_.staleness_updates;
  status.transitions_per_s = transitions_per_s_;
  status.updates_per_s = updates_per_s_;
  const BusCounters counters = CountersLocked();
  status.received = counters.received;
  status.duplicate = counters.duplicate;
  status.rejected = counters.rejected;
  status.lost = counters.lost;
  status.reordered_episodes = counters.reordered_episodes;
  status.waiting_for = WaitingForLocked(now_us).substr(0, 160);
  return status;
}

std::string LearnerNode::WaitingForLocked(int64_t now_us) const {
  if (!finishing_.empty()) {
    return finishing_;
  }
  if (!trainer_waits_ || ledger_.in_flight() == 0 || ledger_.IsComplete(ledger_.committed())) {
    return "";
  }
  const std::string awaited = roster_.Awaited(ledger_.committed(), now_us);
  const std::string reason = roster_.live_actors() == 0 ? key_mismatch_.Reason() : "";
  return reason.empty() ? awaited : fmt::format("{} ({})", awaited, reason);
}

std::string LearnerNode::WaitingFor() const {
  const std::lock_guard lock(mutex_);
  return WaitingForLocked(MonotonicMicroseconds());
}

void LearnerNode::AnnounceEnd() {
  constexpr int kTimes = 3;  // against loss; an actor that misses all of them notices the silence
  for (int i = 0; i < kTimes; ++i) {
    SendRun(true);
    Publish(channels_.learner_status, Status(MonotonicMicroseconds()));
    bus_->Poll(kPollUs);
  }
}

BusCounters LearnerNode::counters() const {
  const std::lock_guard lock(mutex_);
  return CountersLocked();
}

BusCounters LearnerNode::CountersLocked() const {
  BusCounters counters = counters_;
  counters.lost += roster_.late_orders();
  counters.rejected_unauthenticated += bus_->refused_messages();
  counters.rejected += bus_->refused_messages();
  return counters;
}

void LearnerNode::RestoreCounters(const BusCounters& counters) {
  const std::lock_guard lock(mutex_);
  counters_ = counters;
}

int64_t LearnerNode::foreign_run() const {
  const std::lock_guard lock(mutex_);
  return foreign_run_;
}

}  // namespace fresco
