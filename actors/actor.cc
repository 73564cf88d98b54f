#include "actors/actor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "actors/actor_memory.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/identifier.h"
#include "msgs/protocol_times.h"

namespace fresco {
namespace {

constexpr int64_t kLargestIndex = int64_t{1} << 32;

}  // namespace

Actor::Session::Session(Experiment the_experiment, RunIdentity the_identity, int capacity)
    : experiment(std::move(the_experiment)),
      world(experiment.scenario()),
      identity(the_identity),
      store(experiment.network_shape().parameter_count()),
      flyer(world, experiment, capacity) {}

Actor::Actor(Bus& bus, const Channels& channels, ActorOptions options)
    : bus_(bus),
      channels_(channels),
      options_(std::move(options)),
      arithmetic_fingerprint_(ArithmeticFingerprint()) {
  Subscribe(channels_.run, &Actor::HandleRun);
  Subscribe(channels_.orders, &Actor::HandleOrders);
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
  if (session_ != nullptr && session_->identity == identity) {
    if (IsMine(identity, message.utime) && message.finished != 0) {
      spdlog::info("run {} is over", IdentifierText(identity.run_id));
      session_.reset();
      run_over_ = true;
    }
    return;
  }
  const bool wanted = message.run_id != 0 && (options_.run_id == 0 || options_.run_id == message.run_id);
  if (!wanted || (session_ != nullptr && !WouldLeaveFor(message))) {
    ++totals_.rejected.foreign;
    return;
  }
  if (message.finished != 0 || message.run_id == refused_run_) {
    return;
  }
  if (const auto text = announcements_.Add(message)) {
    StartSession(message, *text);
  }
}

/// Whether the run that is served is a recording, and the other one is not.
bool Actor::WouldLeaveFor(const run_t& other) const {
  const int64_t now_utime = options_.wall_clock_us();
  return IsCurrent(other.utime, now_utime) && !IsCurrent(session_->newest_utime, now_utime);
}

void Actor::StartSession(const run_t& message, const std::string& text) {
  try {
    if (message.protocol_version != kProtocolVersion) {
      throw UsageError(
          fmt::format("it speaks protocol version {}, this actor speaks {}; use the same release",
                      message.protocol_version, kProtocolVersion));
    }
    if (message.arithmetic_fingerprint != arithmetic_fingerprint_) {
      throw UsageError(fmt::format(
          "its arithmetic fingerprint is {:08x}, this actor's is {:08x}: the results would differ in "
          "their bits; build both with the same compiler and FRESCO_INSTRUCTION_SET",
          message.arithmetic_fingerprint, arithmetic_fingerprint_));
    }
    Experiment experiment = Experiment::Parse(text, channels_.run);
    if (experiment.hash() != IdentityOf(message).config_hash) {
      throw UsageError(fmt::format("its configuration has hash {:08x}, expected {:08x}", experiment.hash(),
                                   IdentityOf(message).config_hash));
    }
    const int capacity = options_.capacity.value_or(experiment.run().environments_per_actor());
    RefuseIfTooLarge({ActorMemory(experiment, capacity)}, options_.available_memory());
    if (session_ != nullptr) {
      spdlog::warn(
          "leaving run {}: its messages are not of now by this host's clock, those of another run are",
          IdentifierText(session_->identity.run_id));
    }
    session_ = std::make_unique<Session>(std::move(experiment), IdentityOf(message), capacity);
    session_->last_heard_us = attention_.now_us();
    session_->newest_utime = std::max<int64_t>(0, message.utime);
    ++totals_.runs;
    run_over_ = false;
    spdlog::info("serving run {}, configuration {:08x}, {} environments", IdentifierText(message.run_id),
                 IdentityOf(message).config_hash, capacity);
  } catch (const Error& error) {
    NoteRefusal(message.run_id, error.what());
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

/// Counts a message of the run that is served, and refuses all others. A stale one could undo the window or
/// end the run. Where the learner's clock was set back everything is stale, and the actor joins again.
bool Actor::IsMine(RunIdentity identity, int64_t utime) {
  if (session_ == nullptr) {
    return false;
  }
  if (session_->identity != identity) {
    ++totals_.rejected.foreign;
    return false;
  }
  if (utime < session_->newest_utime - kStaleUs) {
    ++totals_.rejected.stale;
    return false;
  }
  session_->newest_utime = std::max(session_->newest_utime, utime);
  session_->last_heard_us = attention_.now_us();
  ++totals_.received_messages;
  return true;
}

void Actor::HandleOrders(const orders_t& message) {
  if (!IsMine(IdentityOf(message), message.utime)) {
    return;
  }
  if (message.committed_orders < 0 || message.committed_orders > kLargestIndex) {
    ++totals_.rejected.inconsistent;
    return;
  }
  KeepWindow(message.committed_orders);
  const int64_t end = WindowEnd(message.committed_orders);
  for (const order_t& wire : message.orders) {
    Order order;
    if (wire.actor_id != options_.actor_id || (wire.index >= 0 && wire.index < message.committed_orders)) {
      continue;
    }
    if (FromWire(wire, order) && order.index < end) {
      TakeOrder(order);
    } else {
      ++totals_.rejected.inconsistent;
    }
  }
}

/// The newest announcement of an order counts: what was flown for another order of that index, by a
/// learner that is no more or a liar, is flown anew.
void Actor::TakeOrder(const Order& order) {
  const auto flown = session_->flown.find(order.index);
  if (flown != session_->flown.end() && flown->second.order == order) {
    SendAgain(flown->second);
  } else if (!session_->flyer.IsFlying(order.index)) {
    session_->waiting.insert_or_assign(order.index, order);
  }
}

void Actor::SendAgain(Flown& flown) {
  if (now_us_ - flown.sent_us >= kResendPeriodUs) {
    flown.sent_us = now_us_;
    ++totals_.resent_episodes;
    Send(flown.result);
  }
}

/// The index behind the last order that the learner can have written by now.
int64_t Actor::WindowEnd(int64_t committed) const {
  return committed + MaximumOrdersInFlight(session_->experiment.schedule().window());
}

/// Bounds memory, also where `committed` has gone back because the learner was resumed.
void Actor::KeepWindow(int64_t committed) {
  session_->committed = committed;
  const int64_t end = WindowEnd(committed);
  const auto keep = [&](auto& by_index) {
    by_index.erase(by_index.begin(), by_index.lower_bound(committed));
    by_index.erase(by_index.lower_bound(end), by_index.end());
  };
  keep(session_->waiting);
  keep(session_->flown);
}

template <NetworkKind kind>
void Actor::HandleWeights(const weights_t& message) {
  if (!IsMine(IdentityOf(message), message.utime)) {
    return;
  }
  NetworkStore& store = session_->store;
  const NetworkStore::Arrival arrival = store.Add(kind, message, now_us_);
  if (arrival == NetworkStore::Arrival::kCompleted) {
    ++totals_.completed_versions;
    totals_.longest_assembly_us = std::max(totals_.longest_assembly_us, store.longest_assembly_us());
  } else if (arrival == NetworkStore::Arrival::kRejected || arrival == NetworkStore::Arrival::kRestarted) {
    ++totals_.rejected.inconsistent;
  }
}

bool Actor::Step(int64_t now_us) {
  now_us_ = now_us;
  attention_.Look(now_us);
  LeaveSilentRun();
  if (session_ != nullptr) {
    StartFlights();
    session_->flyer.Step([this](const Order& order, OrderResult& result) { Finish(order, result); });
  }
  SendStatusIfDue(now_us);
  return session_ != nullptr && !session_->flyer.Idle();
}

void Actor::Finish(const Order& order, OrderResult& result) {
  Send(result);
  ++totals_.episodes;
  totals_.transitions += result.episode.transitions();
  session_->flown.insert_or_assign(order.index, Flown{order, std::move(result), now_us_});
}

/// Silence is what was listened to: a process that was stopped finds its messages waiting when it wakes.
void Actor::LeaveSilentRun() {
  if (session_ != nullptr && attention_.now_us() - session_->last_heard_us > kSilentRunUs) {
    spdlog::warn("nothing heard of run {} for {} s; looking for a run",
                 IdentifierText(session_->identity.run_id), kSilentRunUs / 1'000'000);
    session_.reset();
  }
}

void Actor::StartFlights() {
  Session& session = *session_;
  std::set<NetworkVersion> wanted;
  for (auto it = session.waiting.begin(); it != session.waiting.end();) {
    const Order& order = it->second;
    const NetworkVersion current{NetworkKind::kCurrent, order.current_version};
    const NetworkVersion target{NetworkKind::kTarget, order.target_version};
    auto current_parameters = session.store.Find(current);
    auto target_parameters = session.store.Find(target);
    wanted.insert({current, target});
    if (session.flyer.HasRoom() && current_parameters != nullptr && target_parameters != nullptr) {
      session.flyer.Start(order, std::move(current_parameters), std::move(target_parameters));
      it = session.waiting.erase(it);
    } else {
      ++it;
    }
  }
  session.store.SetWanted(std::move(wanted));
}

void Actor::Send(const OrderResult& result) {
  SplitResult(session_->world, result, options_.actor_id, [this](const transitions_t& message) {
    bus_.Publish(channels_.transitions, message, session_->identity);
  });
}

void Actor::SendStatusIfDue(int64_t now_us) {
  const bool may_request = session_ != nullptr && now_us >= next_request_us_;
  if (now_us < next_status_us_ && !may_request) {
    return;
  }
  next_request_us_ = now_us + kChunkRequestPeriodUs;
  actor_status_t status = Status(now_us);
  if (now_us < next_status_us_ && status.missing_count == 0) {
    return;
  }
  status.sequence = next_sequence_++;
  bus_.Publish(channels_.actor_status, status, session_ != nullptr ? session_->identity : RunIdentity{});
  if (now_us >= next_status_us_) {
    next_status_us_ = now_us + kActorStatusPeriodUs;
    if (const std::string news = bus_.KeyMismatchNews(); !news.empty()) {
      spdlog::warn("{}", news);
    }
  }
}

}  // namespace fresco
