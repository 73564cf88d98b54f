#include "bus/message_assembler.h"

#include <algorithm>
#include <iterator>

#include "core/bytes.h"

namespace fresco {
namespace {

/// Returns the channel name at the beginning of the bytes; nullopt if its zero byte is missing or its length
/// is not allowed.
std::optional<std::string_view> ChannelOf(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                              std::min(bytes.size(), kMaximumLcmChannelBytes + 1));
  const size_t length = text.find('\0');
  if (length == 0 || length == std::string_view::npos) {
    return std::nullopt;
  }
  return text.substr(0, length);
}

}  // namespace

std::optional<AssembledMessage> MessageAssembler::Add(std::span<const std::byte> datagram, uint64_t sender,
                                                      int64_t utime) {
  GiveUpTheSilent(utime);
  if (datagram.size() < kWholeMessageHeaderBytes) {
    return Refuse();
  }
  const auto magic = ReadBigEndian<uint32_t>(datagram.data());
  if (magic == kWholeMessageMagic) {
    return AddWhole(datagram);
  }
  const auto fragment = magic == kFragmentMagic ? ParseFragment(datagram) : std::nullopt;
  return fragment ? AddFragment(*fragment, sender, utime) : Refuse();
}

std::optional<AssembledMessage> MessageAssembler::Refuse() {
  ++refused_datagrams_;
  return std::nullopt;
}

std::optional<AssembledMessage> MessageAssembler::AddWhole(std::span<const std::byte> datagram) {
  const auto rest = datagram.subspan(kWholeMessageHeaderBytes);
  const auto channel = ChannelOf(rest);
  if (!channel) {
    return Refuse();
  }
  const auto content = rest.subspan(channel->size() + 1);
  return AssembledMessage{std::string(*channel), {content.begin(), content.end()}};
}

/// Returns nullopt if the fragment can't be valid, whatever other fragments say.
std::optional<MessageAssembler::Fragment> MessageAssembler::ParseFragment(
    std::span<const std::byte> datagram) {
  if (datagram.size() < kFragmentHeaderBytes) {
    return std::nullopt;
  }
  const std::byte* header = datagram.data();
  Fragment fragment{.sequence = ReadBigEndian<uint32_t>(header + 4),
                    .message_bytes = ReadBigEndian<uint32_t>(header + 8),
                    .offset = ReadBigEndian<uint32_t>(header + 12),
                    .number = ReadBigEndian<uint16_t>(header + 16),
                    .count = ReadBigEndian<uint16_t>(header + 18),
                    .data = datagram.subspan(kFragmentHeaderBytes)};
  if (fragment.number == 0) {
    const auto channel = ChannelOf(fragment.data);
    if (!channel) {
      return std::nullopt;
    }
    fragment.channel = *channel;
    fragment.data = fragment.data.subspan(channel->size() + 1);
  }
  const bool fits = fragment.number < fragment.count && fragment.message_bytes <= kMaximumLcmMessageBytes &&
                    fragment.offset <= fragment.message_bytes &&
                    fragment.data.size() <= fragment.message_bytes - fragment.offset;
  return fits ? std::optional(fragment) : std::nullopt;
}

std::optional<AssembledMessage> MessageAssembler::AddFragment(const Fragment& fragment, uint64_t sender,
                                                              int64_t utime) {
  const auto message = FindOrBegin(fragment, sender);
  if (!Agrees(*message, fragment)) {
    return Refuse();
  }
  message->touched_utime = utime;
  messages_.splice(messages_.end(), messages_, message);
  Store(fragment, *message);
  if (message->parts.size() == message->count) {
    return Finish(message);
  }
  while (memory_bytes_ > memory_limit_bytes_ && messages_.size() > 1) {
    Remove(messages_.begin());
    ++given_up_;
  }
  return std::nullopt;
}

MessageAssembler::Messages::iterator MessageAssembler::FindOrBegin(const Fragment& fragment,
                                                                   uint64_t sender) {
  const Key key{sender, fragment.sequence};
  const auto [entry, is_new] = by_key_.try_emplace(key);
  if (is_new) {
    entry->second = messages_.insert(messages_.end(), {key, fragment.message_bytes, fragment.count});
    memory_bytes_ += MemoryBytes(*entry->second);
  }
  return entry->second;
}

/// Whether the fragment fits those of the message that have arrived.
bool MessageAssembler::Agrees(const Incomplete& message, const Fragment& fragment) {
  if (fragment.message_bytes != message.message_bytes || fragment.count != message.count) {
    return false;
  }
  const auto next = message.parts.lower_bound(fragment.number);
  if (next != message.parts.end() && next->first == fragment.number) {
    return Repeats(message, next->second, fragment);
  }
  const bool ends_before_next =
      next == message.parts.end() || fragment.offset + fragment.data.size() <= next->second.offset;
  if (next == message.parts.begin()) {
    return ends_before_next;
  }
  const Part& previous = std::prev(next)->second;
  return ends_before_next && previous.offset + previous.data.size() <= fragment.offset;
}

bool MessageAssembler::Repeats(const Incomplete& message, const Part& part, const Fragment& fragment) {
  return part.offset == fragment.offset && (fragment.number != 0 || message.channel == fragment.channel) &&
         std::equal(part.data.begin(), part.data.end(), fragment.data.begin(), fragment.data.end());
}

/// Stores a fragment that fits the message, unless it is there already.
void MessageAssembler::Store(const Fragment& fragment, Incomplete& message) {
  if (message.parts.contains(fragment.number)) {
    return;
  }
  memory_bytes_ -= MemoryBytes(message);
  message.parts.emplace(fragment.number, Part{fragment.offset, {fragment.data.begin(), fragment.data.end()}});
  message.arrived_bytes += fragment.data.size();
  if (fragment.number == 0) {
    message.channel = fragment.channel;
  }
  memory_bytes_ += MemoryBytes(message);
}

/// Called when all fragments are there. They ascend and do not overlap, so they leave no hole if and only if
/// together they are as long as the message.
std::optional<AssembledMessage> MessageAssembler::Finish(Messages::iterator message) {
  const Incomplete finished = Remove(message);
  if (finished.arrived_bytes != finished.message_bytes) {
    ++given_up_;
    return std::nullopt;
  }
  AssembledMessage assembled{finished.channel, {}};
  assembled.content.reserve(finished.arrived_bytes);
  for (const auto& [number, part] : finished.parts) {
    assembled.content.insert(assembled.content.end(), part.data.begin(), part.data.end());
  }
  return assembled;
}

MessageAssembler::Incomplete MessageAssembler::Remove(Messages::iterator message) {
  memory_bytes_ -= MemoryBytes(*message);
  Incomplete removed = std::move(*message);
  by_key_.erase(removed.key);
  messages_.erase(message);
  return removed;
}

void MessageAssembler::GiveUpTheSilent(int64_t utime) {
  while (!messages_.empty() && messages_.front().touched_utime + kPatienceUs < utime) {
    Remove(messages_.begin());
    ++given_up_;
  }
}

/// A message's memory, including roughly what the containers need for their entries.
size_t MessageAssembler::MemoryBytes(const Incomplete& message) {
  constexpr size_t kMessageBytes = sizeof(Incomplete) + 256;
  constexpr size_t kPartBytes = 128;
  return kMessageBytes + kPartBytes * message.parts.size() + message.arrived_bytes;
}

}  // namespace fresco
