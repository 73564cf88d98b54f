#include "tests/actors/learner_double.h"

#include <gtest/gtest.h>

#include "core/bytes.h"
#include "msgs/weights_codec.h"
#include "tests/nn/literal_network.h"

namespace fresco {
namespace {

template <class T>
void Append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

LearnerDouble::LearnerDouble(Bus& bus, const Channels& channels, const Experiment& experiment, int64_t run_id)
    : bus_(&bus),
      channels_(channels),
      experiment_(experiment),
      world_(experiment.scenario()),
      identity_{run_id, experiment.hash()} {
  bus.Subscribe(channels.transitions, [this](std::span<const std::byte> bytes) {
    transitions_t message;
    ASSERT_TRUE(Decode(bytes, message));
    if (IdentityOf(message) == identity_) {
      TakeTransitions(message);
    }
  });
  bus.Subscribe(channels.actor_status, [this](std::span<const std::byte> bytes) {
    ASSERT_TRUE(Decode(bytes, statuses_.emplace_back()));
  });
}

void LearnerDouble::TakeTransitions(const transitions_t& message) {
  OrderResult part;
  ASSERT_TRUE(FromWire(world_, message, part));
  if (part.first_transition == 0) {
    open_ = part;
  } else {
    Episode& all = open_.episode;
    ASSERT_EQ(part.order_index, open_.order_index);
    ASSERT_EQ(part.first_transition, all.transitions());
    part.episode.states.erase(part.episode.states.begin());  // the last one of the part before
    Append(part.episode.states, all.states);
    Append(part.episode.actions, all.actions);
    Append(part.episode.rewards, all.rewards);
    Append(part.td_errors, open_.td_errors);
    Append(part.episode.next_masks, all.next_masks);
    all.outcome = part.episode.outcome;
  }
  if (open_.episode.outcome != Outcome::kFlying) {
    results_.push_back(open_);
    senders_.insert(message.actor_id);
  }
}

std::vector<run_t> LearnerDouble::RunParts() const {
  constexpr size_t kPartBytes = 500;
  const std::string text = experiment_.Text();
  std::vector<run_t> parts;
  for (size_t begin = 0; begin < text.size(); begin += kPartBytes) {
    const std::string part = text.substr(begin, kPartBytes);
    run_t message{};
    message.part_index = static_cast<int32_t>(parts.size());
    message.part_count = static_cast<int32_t>((text.size() + kPartBytes - 1) / kPartBytes);
    message.part_size = static_cast<int32_t>(part.size());
    message.part.assign(part.begin(), part.end());
    message.protocol_version = kProtocolVersion;
    message.arithmetic_fingerprint = ArithmeticFingerprint();
    parts.push_back(message);
  }
  return parts;
}

void LearnerDouble::AnnounceRun(const std::function<void(run_t&)>& change) {
  for (run_t part : RunParts()) {
    Stamp(part, identity_, 1);
    change(part);
    Send(channels_.run, part, IdentityOf(part));
  }
}

void LearnerDouble::SendVersion(NetworkVersion version, const Vector& parameters,
                                const std::set<int>& without) {
  const auto values = SpanOf(parameters);
  for (int chunk = 0; chunk < ChunkCount(parameters.size()); ++chunk) {
    if (!without.contains(chunk)) {
      Send(version.kind == NetworkKind::kCurrent ? channels_.weights_current : channels_.weights_target,
           WeightsChunk(values, Crc32c(values), version.number, chunk));
    }
  }
}

void LearnerDouble::SendOrders(const std::vector<order_t>& orders, int64_t committed) {
  orders_t message{};
  message.order_count = static_cast<int32_t>(orders.size());
  message.committed_orders = committed;
  message.orders = orders;
  Send(channels_.orders, message);
}

}  // namespace fresco
