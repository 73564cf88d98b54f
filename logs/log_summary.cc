#include "logs/log_summary.h"

#include <fmt/format.h>

#include <algorithm>

namespace fresco {
namespace {

constexpr size_t kMaximumRecords = 4096;  // of each kind; a limit, since anybody may send names
constexpr int64_t kMaximumOrder = int64_t{1} << 32;
constexpr int64_t kMaximumSequence = int64_t{1} << 53;

std::string TypeText(const char* type, std::span<const std::byte> message) {
  if (type != nullptr) {
    return type;
  }
  std::string text = "foreign ";
  for (const std::byte byte : message.first(std::min<size_t>(message.size(), 8))) {
    text += fmt::format("{:02x}", std::to_integer<int>(byte));
  }
  return text;
}

void NoteType(const char* type, std::span<const std::byte> message, ChannelTraffic& channel) {
  const bool same = type != nullptr ? channel.type == type : channel.type.starts_with("foreign");
  if (channel.events == 0) {
    channel.type = TypeText(type, message);
  } else if (!same) {
    channel.type = "mixed";
  }
}

}  // namespace

int64_t RunTraffic::orders_without_transitions() const {
  const int64_t orders = first_order ? last_order - *first_order + 1 : 0;
  return std::max<int64_t>(0, orders - episodes.whole() - episodes.partial());
}

void LogSummary::Take(const LcmEvent& event) {
  begin_utime_ = events_ == 0 ? event.utime : std::min(begin_utime_, event.utime);
  end_utime_ = events_ == 0 ? event.utime : std::max(end_utime_, event.utime);
  ++events_;
  const char* type = PeekType(event.message);
  const bool sound = type == nullptr || TakeMessage(event.message);
  foreign_ += type == nullptr ? 1 : 0;
  damaged_ += sound ? 0 : 1;
  if (ChannelTraffic* channel = ChannelOf(event.channel)) {
    NoteType(type, event.message, *channel);
    ++channel->events;
    channel->message_bytes += static_cast<int64_t>(event.message.size());
    channel->damaged += sound ? 0 : 1;
  }
}

/// Returns false if the message is damaged.
bool LogSummary::TakeMessage(std::span<const std::byte> message) {
  if (BeginsAs<weights_t>(message)) {
    return true;
  }
  if (BeginsAs<transitions_t>(message)) {
    const auto header = PeekTransitions(message);
    if (header) {
      Take(*header);
    }
    return header.has_value();
  }
  return decoder_.Decode(message, [this](const auto& decoded) { Take(decoded); }) ==
         MessageDecoder::Result::kDecoded;
}

ChannelTraffic* LogSummary::ChannelOf(std::string_view name) {
  if (const auto found = channels_.find(name); found != channels_.end()) {
    return &found->second;
  }
  if (channels_.size() >= kMaximumRecords) {
    ++beyond_limits_;
    return nullptr;
  }
  return &channels_.try_emplace(std::string(name)).first->second;
}

template <class Record>
Record* LogSummary::RecordOf(std::map<int64_t, Record>& records, int64_t id) {
  if (const auto found = records.find(id); found != records.end()) {
    return &found->second;
  }
  if (records.size() >= kMaximumRecords) {
    ++beyond_limits_;
    return nullptr;
  }
  return &records.try_emplace(id).first->second;
}

void LogSummary::Take(const TransitionsHeader& header) {
  RunTraffic* run = RecordOf(runs_, header.identity.run_id);
  const bool possible = header.order_index >= 0 && header.order_index < kMaximumOrder &&
                        header.first_transition >= 0 && header.transition_count > 0;
  if (run == nullptr || !possible) {
    return;
  }
  run->config_hash = header.identity.config_hash;
  run->episodes.Add(header.order_index, header.first_transition, header.transition_count,
                    header.ends_episode);
  run->last_order = std::max(run->last_order, header.order_index);
  run->first_order = std::min(run->first_order.value_or(header.order_index), header.order_index);
  if (run->actors.size() < kMaximumRecords) {
    run->actors.insert(header.actor_id);
  }
}

void LogSummary::Take(const run_t& message) {
  RunTraffic* run = RecordOf(runs_, message.run_id);
  if (run == nullptr) {
    return;
  }
  run->config_hash = IdentityOf(message).config_hash;
  run->finished = run->finished || message.finished != 0;
  if (message.part_count <= kMaximumParts && message.part_index >= 0 &&
      message.part_index < message.part_count) {
    run->config_part_count = message.part_count;
    run->config_parts.Add(message.part_index, message.part_index);
  }
}

void LogSummary::Take(const orders_t& message) {
  RunTraffic* run = RecordOf(runs_, message.run_id);
  if (run == nullptr) {
    return;
  }
  run->config_hash = IdentityOf(message).config_hash;
  run->committed_orders = std::max(run->committed_orders, message.committed_orders);
  for (const order_t& order : message.orders) {
    if (order.index >= 0 && order.index < kMaximumOrder) {
      run->last_order = std::max(run->last_order, order.index);
      run->first_order = std::min(run->first_order.value_or(order.index), order.index);
    }
  }
}

void LogSummary::Take(const actor_status_t& message) {
  ActorTraffic* actor = RecordOf(actors_, message.actor_id);
  if (actor == nullptr) {
    return;
  }
  actor->host = message.host;
  actor->pid = message.pid;
  ++actor->statuses;
  if (message.sequence >= 0 && message.sequence < kMaximumSequence) {
    actor->sequences.Add(message.sequence, message.sequence);
  }
}

void LogSummary::Take(const learner_status_t& message) {
  if (RunTraffic* run = RecordOf(runs_, message.run_id)) {
    run->config_hash = IdentityOf(message).config_hash;
    run->learner_status = message;
  }
}

}  // namespace fresco
