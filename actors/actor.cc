#include "actors/actor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

constexpr int64_t kStatusPeriodUs = 100'000;
constexpr int64_t kQuietUs = 4'000;          // no chunk for so long: what is missing was lost
constexpr int64_t kRequestPeriodUs = 8'000;  // between two requests for missing chunks
constexpr int64_t kSilentRunUs = 10'000'000;

}  // namespace

Actor::Session::Session(Experiment the_experiment, RunIdentity the_identity, int capacity)
    : experiment(std::move(the_experiment)),
      world(experiment.scenario()),
      identity(the_identity),
      store(experiment.network_shape().parameter_count()),
      flyer(world, experiment, capacity) {}

Actor::Actor(Bus& bus, const Channels& channels, ActorOptions options)
    : bus_(&bus),
      channels_(channels),
      options_(std::move(options)),
      arithmetic_fingerprint_(ArithmeticFingerprint()),
      key_mismatch_(bus) {
  Subscribe<run_t>(channels_.run, [this](const run_t& message) { HandleRun(message); });
  Subscribe<orders_t>(channels_.orders, [this](const orders_t& message) { HandleOrders(message); });
  Subscribe<weights_t>(channels_.weights_current,
                       [this](const weights_t& message) { HandleWeights(NetworkKind::kCurrent, message); });
  Subscribe<weights_t>(channels_.weights_target,
                       [this](const weights_t& message) { HandleWeights(NetworkKind::kTarget, message); });
}

template <class Message, class Handler>
void Actor::Subscribe(const std::string& channel, Handler handler) {
  auto message = std::make_shared<Message>();
  bus_->Subscribe(channel, [this, handler, message](std::span<const std::byte> bytes) {
    if (!Decode(bytes, *message)) {
      ++totals_.rejected_messages;
      key_mismatch_.Note(bytes);
      return;
    }
    now_us_ = MonotonicMicroseconds();
    handler(*message);
  });
}

void Actor::HandleRun(const run_t& message) {
  const RunIdentity identity = IdentityOf(message);
  if (session_ != nullptr && session_->identity == identity) {
    session_->last_heard_us = now_us_;
    if (message.finished != 0) {
      spdlog::info("run {:016x} is over", static_cast<uint64_t>(identity.run_id));
      session_.reset();
      run_over_ = true;
    }
    return;
  }
  const bool wanted = options_.run_id == 0 || options_.run_id == message.run_id;
  if (session_ != nullptr || !wanted || message.run_id == 0) {
    ++totals_.rejected_messages;
    return;
  }
  if (message.finished != 0 || message.run_id == refused_run_) {
    return;
  }
  if (const auto text = announcements_.Add(message)) {
    StartSession(message, *text);
  }
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
    session_ = std::make_unique<Session>(std::move(experiment), IdentityOf(message), capacity);
    session_->last_heard_us = now_us_;
    ++totals_.runs;
    run_over_ = false;
    spdlog::info("serving run {:016x}, configuration {:08x}, {} environments",
                 static_cast<uint64_t>(message.run_id), IdentityOf(message).config_hash, capacity);
  } catch (const Error& error) {
    refused_run_ = message.run_id;
    spdlog::error("run {:016x} on {} can't be served: {}", static_cast<uint64_t>(message.run_id),
                  channels_.run, error.what());
  }
}

bool Actor::IsMine(RunIdentity identity) {
  if (session_ == nullptr) {
    return false;
  }
  if (session_->identity != identity) {
    ++totals_.rejected_messages;
    return false;
  }
  session_->last_heard_us = now_us_;
  return true;
}

void Actor::HandleOrders(const orders_t& message) {
  if (!IsMine(IdentityOf(message))) {
    return;
  }
  ForgetCommitted(message.committed_orders);
  for (const order_t& order : message.orders) {
    if (order.actor_id == options_.actor_id && order.index >= message.committed_orders) {
      TakeOrder(order);
    }
  }
}

void Actor::TakeOrder(const order_t& wire) {
  Order order;
  if (!FromWire(wire, order)) {
    ++totals_.rejected_messages;
    return;
  }
  int32_t& answered = session_->attempts.try_emplace(order.index, -1).first->second;
  const bool asked_again = wire.attempt > answered;
  answered = std::max(answered, wire.attempt);
  const auto flown = session_->flown.find(order.index);
  if (flown != session_->flown.end()) {
    if (asked_again) {
      ++totals_.resent_episodes;
      Send(flown->second);
    }
  } else if (!session_->flyer.IsFlying(order.index)) {
    session_->waiting.try_emplace(order.index, order);
  }
}

void Actor::ForgetCommitted(int64_t committed) {
  const auto forget = [&](auto& by_index) {
    by_index.erase(by_index.begin(), by_index.lower_bound(committed));
  };
  forget(session_->waiting);
  forget(session_->flown);
  forget(session_->attempts);
}

void Actor::HandleWeights(NetworkKind kind, const weights_t& message) {
  if (IsMine(IdentityOf(message)) &&
      session_->store.Add(kind, message, now_us_) == NetworkStore::Arrival::kRejected) {
    ++totals_.rejected_messages;
  }
}

bool Actor::Step(int64_t now_us) {
  now_us_ = now_us;
  LeaveSilentRun(now_us);
  if (session_ != nullptr) {
    StartFlights();
    session_->flyer.Step([this](const Episode& episode) {
      Send(episode);
      ++totals_.episodes;
      totals_.transitions += episode.transitions();
      session_->flown.insert_or_assign(episode.order_index, episode);
    });
  }
  SendStatusIfDue(now_us);
  return session_ != nullptr && !session_->flyer.Idle();
}

void Actor::LeaveSilentRun(int64_t now_us) {
  if (session_ != nullptr && now_us - session_->last_heard_us > kSilentRunUs) {
    spdlog::warn("nothing heard of run {:016x} for {} s; looking for a run",
                 static_cast<uint64_t>(session_->identity.run_id), kSilentRunUs / 1'000'000);
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

void Actor::Send(const Episode& episode) {
  SendEpisode(session_->world, episode, session_->identity, options_.actor_id,
              [this](std::span<const std::byte> bytes) { bus_->Publish(channels_.transitions, bytes); });
}

void Actor::SendStatusIfDue(int64_t now_us) {
  const bool may_request = session_ != nullptr && now_us >= next_request_us_ && !session_->waiting.empty();
  if (now_us < next_status_us_ && !may_request) {
    return;
  }
  actor_status_t status = Status(now_us);
  if (now_us < next_status_us_ && status.missing_count == 0) {
    return;
  }
  Stamp(status, session_ != nullptr ? session_->identity : RunIdentity{}, WallMicroseconds());
  std::vector<std::byte> bytes;
  Encode(status, bytes);
  bus_->Publish(channels_.actor_status, bytes);
  next_request_us_ = now_us + kRequestPeriodUs;
  if (now_us >= next_status_us_) {
    next_status_us_ = now_us + kStatusPeriodUs;
    if (const std::string news = key_mismatch_.News(); !news.empty()) {
      spdlog::warn("{}", news);
    }
  }
}

actor_status_t Actor::Status(int64_t now_us) {
  constexpr int64_t kRatePeriodUs = 1'000'000;
  if (now_us - rate_since_us_ >= kRatePeriodUs) {
    const double seconds = static_cast<double>(now_us - rate_since_us_) * 1e-6;
    transitions_per_s_ =
        static_cast<float>(static_cast<double>(totals_.transitions - rate_transitions_) / seconds);
    rate_since_us_ = now_us;
    rate_transitions_ = totals_.transitions;
  }
  actor_status_t status{};
  status.actor_id = options_.actor_id;
  status.pid = options_.pid;
  status.host = options_.host.substr(0, 64);
  status.arithmetic_fingerprint = arithmetic_fingerprint_;
  status.episodes = totals_.episodes;
  status.transitions = totals_.transitions;
  status.resent_episodes = totals_.resent_episodes;
  status.rejected_messages = totals().rejected_messages;
  status.transitions_per_s = transitions_per_s_;
  if (session_ != nullptr) {
    status.capacity = options_.capacity.value_or(session_->experiment.run().environments_per_actor());
    status.open_orders = static_cast<int32_t>(session_->waiting.size()) + session_->flyer.open_flights();
    status.held = session_->store.HeldVersions();
    status.missing = session_->store.MissingRanges(now_us, kQuietUs);
  }
  status.held_count = static_cast<int32_t>(status.held.size());
  status.missing_count = static_cast<int32_t>(status.missing.size());
  return status;
}

std::string Actor::Description() const {
  return fmt::format(
      "actor {:016x}: {} run(s) served, {} episodes, {} transitions, {} sent again, {} messages rejected",
      static_cast<uint64_t>(options_.actor_id), totals_.runs, totals_.episodes, totals_.transitions,
      totals_.resent_episodes, totals().rejected_messages);
}

ActorTotals Actor::totals() const {
  ActorTotals totals = totals_;
  totals.rejected_messages += bus_->refused_messages();
  return totals;
}

}  // namespace fresco
