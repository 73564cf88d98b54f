#include "actors/served_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/identifier.h"
#include "msgs/protocol_times.h"
#include "msgs/versions_in_flight.h"

namespace fresco {
namespace {

constexpr int64_t kLargestIndex = int64_t{1} << 32;
constexpr size_t kLongestList = 32;

bool IsBefore(const Order& order, int64_t index) {
  return order.index < index;
}

std::string Names(const std::vector<chunk_range_t>& ranges) {
  std::string text;
  for (const chunk_range_t& range : ranges) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", Name(VersionOf(range).kind), range.version);
  }
  return text.empty() ? "none" : text;
}

}  // namespace

ServedRun::ServedRun(Experiment experiment, RunIdentity identity, int capacity, SendResult send)
    : experiment_(std::move(experiment)),
      identity_(identity),
      capacity_(capacity),
      send_(std::move(send)),
      store_(experiment_.network()->parameter_count()),
      flyer_(experiment_, capacity) {}

bool ServedRun::Hear(int64_t utime, int64_t now_us) {
  if (utime < newest_utime_ - kStaleUs) {
    return false;
  }
  newest_utime_ = std::max(newest_utime_, utime);
  last_heard_us_ = now_us;
  return true;
}

NetworkStore::Arrival ServedRun::AddWeights(NetworkKind kind, const weights_t& message, int64_t now_us) {
  const NetworkStore::Arrival arrival = store_.Add(kind, message, now_us);
  news_ |= arrival == NetworkStore::Arrival::kCompleted;
  return arrival;
}

int ServedRun::HandleOrders(const orders_t& message, int64_t actor_id, int64_t now_us) {
  if (message.committed_orders < 0 || message.committed_orders > kLargestIndex) {
    return 1;
  }
  committed_ = message.committed_orders;
  KeepWindow();
  int contradictions = 0;
  for (const order_t& wire : message.orders) {
    Order order;
    if (wire.actor_id != actor_id || (wire.index >= 0 && wire.index < committed_)) {
      continue;
    }
    if (FromWire(wire, order) && order.index < WindowEnd() &&
        SearchFits(order, experiment_.schedule(), experiment_.world().longest_episode())) {
      Accept(order, now_us);
    } else {
      ++contradictions;
    }
  }
  return contradictions;
}

/// The newest announcement of an index counts. If another order of that index was flown (its message came
/// from a learner that has ended, or was forged), the new one is flown.
void ServedRun::Accept(const Order& order, int64_t now_us) {
  const auto flown = flown_.find(order.index);
  if (flown != flown_.end() && flown->second.order == order) {
    if (now_us - flown->second.sent_us >= kResendPeriodUs) {
      flown->second.sent_us = now_us;
      send_(flown->second.result, true);
    }
  } else if (!flyer_.IsFlying(order.index)) {
    const auto at = std::lower_bound(waiting_.begin(), waiting_.end(), order.index, IsBefore);
    if (at != waiting_.end() && at->index == order.index) {
      *at = order;
    } else {
      waiting_.insert(at, order);
    }
    news_ = true;
  }
}

/// One more than the highest index that the learner can have written by now.
int64_t ServedRun::WindowEnd() const {
  return committed_ + MaximumOrdersInFlight(experiment_.schedule());
}

/// Bounds memory, also if the window has moved back because the learner was resumed.
void ServedRun::KeepWindow() {
  const size_t waiting = waiting_.size();
  std::erase_if(waiting_, [this](const Order& order) {
    return order.index < committed_ || order.index >= WindowEnd();
  });
  news_ |= waiting_.size() != waiting;
  Forget(flown_.begin(), flown_.lower_bound(committed_));
  Forget(flown_.lower_bound(WindowEnd()), flown_.end());
}

void ServedRun::Forget(std::map<int64_t, Flown>::iterator first, std::map<int64_t, Flown>::iterator last) {
  while (first != last) {
    spare_.push_back(flown_.extract(first++));
  }
}

/// Keeps a copy of the result.
void ServedRun::Keep(const Order& order, const OrderResult& result, int64_t now_us) {
  auto kept = flown_.find(order.index);
  if (kept == flown_.end() && !spare_.empty()) {
    spare_.back().key() = order.index;
    kept = flown_.insert(std::move(spare_.back())).position;
    spare_.pop_back();
  } else if (kept == flown_.end()) {
    kept = flown_.try_emplace(order.index).first;
  }
  kept->second.order = order;
  kept->second.result = result;
  kept->second.sent_us = now_us;
}

void ServedRun::Step(int64_t now_us) {
  if (std::exchange(news_, false)) {
    StartFlights();
  }
  flyer_.Step([&](const Order& order, const OrderResult& result) {
    send_(result, false);
    Keep(order, result, now_us);
    news_ = true;
  });
}

void ServedRun::StartFlights() {
  std::set<NetworkVersion> wanted;
  std::erase_if(waiting_, [&](const Order& order) {
    const auto [current, target] = VersionsOf(order);
    auto current_parameters = store_.Find(current);
    auto target_parameters = store_.Find(target);
    if (!flyer_.HasRoom() || current_parameters == nullptr || target_parameters == nullptr) {
      wanted.insert({current, target});
      return false;
    }
    flyer_.Start(order, std::move(current_parameters), std::move(target_parameters));
    return true;
  });
  store_.SetWanted(std::move(wanted));
}

int64_t ServedRun::OldestOpenOrder() const {
  std::vector<int64_t> open = flyer_.OrderIndices();
  std::erase_if(open, [this](int64_t index) { return index < committed_; });
  if (!waiting_.empty()) {
    open.push_back(waiting_.front().index);
  }
  return open.empty() ? -1 : *std::min_element(open.begin(), open.end());
}

void ServedRun::WriteTo(actor_status_t& status, int64_t now_us) {
  status.capacity = capacity_;
  status.open_orders = static_cast<int32_t>(waiting_.size()) + flyer_.open_flights();
  status.oldest_open_order = OldestOpenOrder();
  status.held = store_.HeldVersions();
  status.missing = store_.MissingRanges(now_us);
  status.held_count = static_cast<int32_t>(status.held.size());
  status.missing_count = static_cast<int32_t>(status.missing.size());
}

std::string ServedRun::WaitsFor(const Order& order) const {
  std::string text;
  for (const NetworkVersion& version : VersionsOf(order)) {
    if (const int missing = store_.MissingChunks(version); missing > 0) {
      text += fmt::format("{}{} network {} ({} chunks missing)", text.empty() ? "" : " and ",
                          Name(version.kind), version.number, missing);
    }
  }
  return text.empty() ? "room" : text;
}

std::string ServedRun::StateText(int64_t now_us) const {
  std::string text =
      fmt::format("\n  run {}, last heard of {:.1f} s ago\n  {} orders flying, {} flown and kept",
                  IdentifierText(identity_.run_id), static_cast<double>(now_us - last_heard_us_) * 1e-6,
                  flyer_.open_flights(), flown_.size());
  size_t lines = 0;
  for (const Order& order : waiting_) {
    if (++lines > kLongestList) {
      text += fmt::format("\n  and {} orders more", waiting_.size() - kLongestList);
      break;
    }
    text += fmt::format("\n  order {} waits for {}", order.index, WaitsFor(order));
  }
  return text + "\n  networks held: " + Names(store_.HeldVersions());
}

MemoryNeed ActorMemory(const Experiment& experiment, int capacity) {
  const World& world = experiment.world();
  const int64_t parameters = experiment.network()->parameter_count();
  const int64_t orders = MaximumOrdersInFlight(experiment.schedule());
  const VersionsInFlight versions = MostVersionsInFlight(experiment);
  const int64_t wanted = std::min(orders, versions.current) + std::min(orders, versions.target);
  constexpr int64_t kGrowth = 2;  // a vector that grows may have twice the room that it needs
  const int64_t of_order = (kGrowth + 1) * static_cast<int64_t>(sizeof(Order)) + LongestResultBytes(world);
  return {
      "actor",
      1,
      {{"run.environments_per_actor", "its environments",
        Flyer::BytesFor(experiment, capacity, std::min<int64_t>(capacity, orders))},
       {experiment.network_field(), "the networks that it holds", NetworkStore::BytesFor(parameters, wanted)},
       {"schedule.window", "the episodes of the orders in flight", orders * of_order},
       {"world", "the world", world.bytes()},
       {"run.actors", "the program", kProgramBytes}}};
}

}  // namespace fresco
