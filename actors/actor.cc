#include "actors/actor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/identifier.h"
#include "msgs/protocol_times.h"
#include "nn/mlp.h"

namespace fresco {
namespace {

double Milliseconds(int64_t us) {
  return static_cast<double>(us) * 1e-3;
}

std::string Text(const RejectedMessages& rejected) {
  std::string causes;
  for (const auto& [count, cause] : {std::pair{rejected.malformed, "malformed"},
                                     {rejected.foreign, "foreign"},
                                     {rejected.stale, "stale"},
                                     {rejected.inconsistent, "inconsistent"},
                                     {rejected.unauthenticated, "unauthenticated"}}) {
    if (count > 0) {
      causes += fmt::format("{}{} {}", causes.empty() ? ": " : ", ", count, cause);
    }
  }
  return fmt::format("{} rejected{}", rejected.total(), causes);
}

}  // namespace

Actor::Actor(Bus& bus, const Channels& channels, ActorOptions options)
    : bus_(bus),
      channels_(channels),
      options_(std::move(options)),
      arithmetic_fingerprint_(ArithmeticFingerprint()) {
  Subscribe(channels_.run, &Actor::HandleRun);
  Subscribe(channels_.orders, &Actor::HandleOrders);
  Subscribe(channels_.probe, &Actor::HandleProbe);
  Subscribe(channels_.weights_current, &Actor::HandleWeights<NetworkKind::kCurrent>);
  Subscribe(channels_.weights_target, &Actor::HandleWeights<NetworkKind::kTarget>);
}

template <class Message>
void Actor::Subscribe(const std::string& channel, void (Actor::*handle)(const Message&)) {
  bus_.Subscribe<Message>(channel, [this, handle](const Message& message) {
    now_us_ = options_.clock_us();
    (this->*handle)(message);
  });
}

void Actor::HandleRun(const run_t& message) {
  const RunIdentity identity = IdentityOf(message);
  if (run_ != nullptr && run_->identity() == identity) {
    if (IsMine(identity, message.utime) && message.finished != 0) {
      spdlog::info("run {} is over", IdentifierText(identity.run_id));
      run_.reset();
      run_over_ = true;
    }
    return;
  }
  const bool wanted = message.run_id != 0 && (options_.run_id == 0 || options_.run_id == message.run_id);
  if (!wanted || (run_ != nullptr && !WouldLeaveFor(message))) {
    ++totals_.rejected.foreign;
    return;
  }
  if (message.finished != 0 || message.run_id == refused_run_) {
    return;
  }
  if (const auto text = announcements_.Add(message)) {
    Join(message, *text);
  }
}

/// Answers, so that the doctor learns what the network carries. A flood of probes gets few answers.
void Actor::HandleProbe(const probe_t& probe) {
  constexpr int kMaximumEchoesPerSecond = 20'000;
  if (probe.run_id == 0 || probe.actor_id != 0) {
    return;
  }
  auto series = std::find_if(probes_.begin(), probes_.end(),
                             [&](const ProbeSeries& known) { return known.run_id == probe.run_id; });
  if (series == probes_.end()) {
    series = probes_.begin() + static_cast<ptrdiff_t>(next_probes_++ % probes_.size());
    *series = {probe.run_id, 0};
  }
  ++series->received;
  if (const int64_t second = now_us_ / 1'000'000; second != echo_second_) {
    echo_second_ = second;
    echoes_ = 0;
  }
  if (++echoes_ > kMaximumEchoesPerSecond) {
    return;
  }
  probe_t echo = probe;
  echo.actor_id = options_.actor_id;
  echo.host = options_.host.substr(0, probe_t::MAXIMUM_HOST_BYTES);
  echo.pid = options_.pid;
  echo.received = series->received;
  bus_.Publish(channels_.echo, std::move(echo), {probe.run_id, 0});
}

/// Whether the run that is served is a recording, and the other one is not.
bool Actor::WouldLeaveFor(const run_t& other) const {
  const int64_t now_utime = options_.wall_clock_us();
  return IsCurrent(other.utime, now_utime) && !IsCurrent(run_->newest_utime(), now_utime);
}

void Actor::Join(const run_t& message, const std::string& text) {
  try {
    if (message.protocol_version != kProtocolVersion) {
      throw UsageError(
          fmt::format("it speaks protocol version {}, this actor speaks {}; use the same release",
                      message.protocol_version, kProtocolVersion));
    }
    if (message.arithmetic_fingerprint != arithmetic_fingerprint_) {
      throw UsageError(fmt::format(
          "its arithmetic fingerprint is {:08x}, this actor's is {:08x}: the results would differ in "
          "their bits; use the same release on both hosts, without compiler options like -ffast-math",
          message.arithmetic_fingerprint, arithmetic_fingerprint_));
    }
    RefuseOtherCode(Experiment::CodeIn(text, channels_.run));
    Experiment experiment = Experiment::Parse(text, channels_.run);
    if (experiment.hash() != IdentityOf(message).config_hash) {
      throw UsageError(fmt::format("its configuration has hash {:08x}, expected {:08x}", experiment.hash(),
                                   IdentityOf(message).config_hash));
    }
    const int capacity = options_.capacity.value_or(experiment.run().environments_per_actor());
    RefuseIfTooLarge({ActorMemory(experiment, capacity)}, options_.available_memory());
    if (run_ != nullptr) {
      spdlog::warn(
          "leaving run {}: its messages are not current by this host's clock, those of another run are",
          IdentifierText(run_->identity().run_id));
    }
    run_ =
        std::make_unique<ServedRun>(std::move(experiment), IdentityOf(message), capacity,
                                    [this](const OrderResult& result, bool again) { Send(result, again); });
    run_->Hear(std::max<int64_t>(0, message.utime), attention_.now_us());
    ++totals_.runs;
    run_over_ = false;
    spdlog::info("serving run {}, configuration {:08x}, {} environments", IdentifierText(message.run_id),
                 IdentityOf(message).config_hash, capacity);
  } catch (const Error& error) {
    NoteRefusal(message.run_id, error.what());
  }
}

/// Throws UsageError if the run's world has code that this actor was not told to run. Whoever can send
/// messages is not to decide what runs on this host.
void Actor::RefuseOtherCode(const std::string& code) const {
  const auto is_same = [&](const std::filesystem::path& allowed) {
    return std::filesystem::weakly_canonical(allowed) == std::filesystem::weakly_canonical(code);
  };
  if (!code.empty() && std::none_of(options_.allowed_code.begin(), options_.allowed_code.end(), is_same)) {
    throw UsageError(fmt::format(
        "its world runs the code {}; to let it, start the actor with --allow-code {}", code, code));
  }
}

/// Says it once, of one run every ten seconds: whoever floods the bus with runs is not to fill the log.
void Actor::NoteRefusal(int64_t run_id, const char* reason) {
  constexpr int64_t kPeriodUs = 10'000'000;
  if (now_us_ >= next_refusal_us_) {
    spdlog::error("run {} on {} can't be served: {}", IdentifierText(run_id), channels_.run, reason);
    next_refusal_us_ = now_us_ + kPeriodUs;
    refused_run_ = run_id;
  }
}

/// Counts a message of the run that is served, and refuses all others.
bool Actor::IsMine(RunIdentity identity, int64_t utime) {
  if (run_ == nullptr) {
    return false;
  }
  if (run_->identity() != identity) {
    ++totals_.rejected.foreign;
    return false;
  }
  const bool newly = run_->Hear(utime, attention_.now_us());
  ++(newly ? totals_.received_messages : totals_.rejected.stale);
  return newly;
}

void Actor::HandleOrders(const orders_t& message) {
  if (IsMine(IdentityOf(message), message.utime)) {
    totals_.rejected.inconsistent += run_->HandleOrders(message, options_.actor_id, now_us_);
  }
}

template <NetworkKind kind>
void Actor::HandleWeights(const weights_t& message) {
  if (!IsMine(IdentityOf(message), message.utime)) {
    return;
  }
  const NetworkStore::Arrival arrival = run_->AddWeights(kind, message, now_us_);
  if (arrival == NetworkStore::Arrival::kCompleted) {
    ++totals_.completed_versions;
    totals_.longest_assembly_us = std::max(totals_.longest_assembly_us, run_->store().longest_assembly_us());
  } else if (arrival == NetworkStore::Arrival::kRejected || arrival == NetworkStore::Arrival::kRestarted) {
    ++totals_.rejected.inconsistent;
  }
}

bool Actor::Step(int64_t now_us) {
  now_us_ = now_us;
  attention_.Look(now_us);
  LeaveSilentRun();
  if (run_ != nullptr) {
    run_->Step(now_us);
  }
  SendStatusIfDue(now_us);
  return run_ != nullptr && !run_->Idle();
}

/// Silence is what was listened to: a process that was stopped finds its messages waiting when it wakes.
void Actor::LeaveSilentRun() {
  if (run_ != nullptr && attention_.now_us() - run_->last_heard_us() > kSilentRunUs) {
    spdlog::warn("nothing heard of run {} for {} s; looking for a run",
                 IdentifierText(run_->identity().run_id), kSilentRunUs / 1'000'000);
    run_.reset();
  }
}

void Actor::Send(const OrderResult& result, bool again) {
  if (again) {
    ++totals_.resent_episodes;
  } else {
    ++totals_.episodes;
    totals_.transitions += result.episode.transitions();
  }
  SplitResult(run_->world(), result, options_.actor_id, [this](transitions_t& message) {
    bus_.Publish(channels_.transitions, message, run_->identity());
  });
}

void Actor::SendStatusIfDue(int64_t now_us) {
  const bool may_request = run_ != nullptr && now_us >= next_request_us_;
  if (now_us < next_status_us_ && !may_request) {
    return;
  }
  next_request_us_ = now_us + kChunkRequestPeriodUs;
  actor_status_t status = Status(now_us);
  if (now_us < next_status_us_ && status.missing_count == 0) {
    return;
  }
  status.sequence = next_sequence_++;
  bus_.Publish(channels_.actor_status, status, run_ != nullptr ? run_->identity() : RunIdentity{});
  if (now_us >= next_status_us_) {
    next_status_us_ = now_us + kActorStatusPeriodUs;
    if (const std::string news = bus_.KeyMismatchNews(); !news.empty()) {
      spdlog::warn("{}", news);
    }
  }
}

actor_status_t Actor::Status(int64_t now_us) {
  actor_status_t status{};
  status.actor_id = options_.actor_id;
  status.pid = options_.pid;
  status.host = options_.host.substr(0, kMaximumHostBytes);
  status.arithmetic_fingerprint = arithmetic_fingerprint_;
  status.episodes = totals_.episodes;
  status.transitions = totals_.transitions;
  status.resent_episodes = totals_.resent_episodes;
  status.rejected_messages = totals().rejected.total();
  status.processor_us = ProcessProcessorMicroseconds();
  status.transitions_per_s = static_cast<float>(rate_.Measure(totals_.transitions, now_us));
  status.weights_latency_ms = static_cast<float>(Milliseconds(totals_.longest_assembly_us));
  status.oldest_open_order = -1;
  if (run_ != nullptr) {
    run_->WriteTo(status, now_us);
  }
  return status;
}

ActorTotals Actor::totals() const {
  ActorTotals totals = totals_;
  totals.rejected.malformed = bus_.malformed_messages();
  totals.rejected.unauthenticated = bus_.unauthenticated_messages();
  return totals;
}

std::string Actor::Description() const {
  return fmt::format(
      "actor {}: {} run(s) served, {} episodes, {} transitions, {} sent again, {} versions completed, "
      "the slowest within {:.1f} ms, {} messages received, {}",
      IdentifierText(options_.actor_id), totals_.runs, totals_.episodes, totals_.transitions,
      totals_.resent_episodes, totals_.completed_versions, Milliseconds(totals_.longest_assembly_us),
      totals_.received_messages, Text(totals().rejected));
}

std::string Actor::StateText() const {
  return "state\n  " + Description() +
         (run_ == nullptr ? "\n  waits for a run" : run_->StateText(attention_.now_us()));
}

}  // namespace fresco
