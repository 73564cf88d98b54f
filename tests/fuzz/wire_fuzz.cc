// Decode of every message type. The first byte chooses the type and whether the rest has a trailer of its
// own or gets the right one here. What decodes must encode to the same bytes again, and looks the same to
// those who only peek; what nobody signed is not authentic.
#include <array>
#include <tuple>

#include "bus/authenticated_bus.h"
#include "core/error.h"
#include "msgs/message_decoder.h"
#include "msgs/order.h"
#include "msgs/run_announcements.h"
#include "msgs/weights_codec.h"
#include "msgs/world_messages.h"
#include "tests/fuzz/fuzz_input.h"

namespace fresco {
namespace {

constexpr uint8_t kOwnTrailer = 0x80;
constexpr int64_t kParameters = 58'196;  // the paper's network

template <class Message>
void CheckContent(const Message&) {}

void CheckContent(const weights_t& message) {
  const int chunk = ChunkIndex(message, kParameters);
  FRESCO_CHECK(chunk >= -1 && chunk < ChunkCount(kParameters));
  FRESCO_CHECK(chunk < 0 || message.offset + message.value_count <= kParameters);
}

void CheckContent(const orders_t& message) {
  for (const order_t& wire : message.orders) {
    if (Order order; FromWire(wire, order)) {
      FRESCO_CHECK(order.index >= 0 && order.epsilon >= 0 && order.epsilon <= 1);
      FRESCO_CHECK(order.current_version >= 0 && order.target_version >= 0);
    }
  }
}

void CheckContent(const run_t& message) {
  RunAnnouncements announcements;
  const auto text = announcements.Add(message);
  FRESCO_CHECK(!text ||
               (message.part_count == 1 && *text == std::string(message.part.begin(), message.part.end())));
}

void CheckContent(const world_t& message) {
  WorldNamesReader reader;
  reader.Add(message);
  if (const WorldNames* names = reader.names()) {
    FRESCO_CHECK(names->state.size() == static_cast<size_t>(message.state_size));
    FRESCO_CHECK(names->actions.size() == static_cast<size_t>(message.action_count));
    FRESCO_CHECK(names->figures.size() == static_cast<size_t>(message.figure_count));
  }
}

void CheckPeeked(const std::vector<std::byte>& bytes, const transitions_t& message) {
  const auto header = PeekTransitions(bytes);
  FRESCO_CHECK(header && header->identity == IdentityOf(message));
  FRESCO_CHECK(header->transition_count == message.transition_count);
  FRESCO_CHECK(header->order_index == message.order_index && header->actor_id == message.actor_id);
}

template <class Message>
void CheckPeeked(const std::vector<std::byte>& bytes, const Message& message) {
  const auto identity = PeekIdentity(bytes);
  FRESCO_CHECK(identity && *identity == IdentityOf(message));
}

void CheckUntrusted(std::span<const std::byte> bytes) {
  static const AuthenticationKey key(std::as_bytes(std::span("a key that no input knows")));
  FRESCO_CHECK(!AuthenticContent(key, "FRESCO_RUN", bytes));
  PeekType(bytes);
  PeekIdentity(bytes);
  PeekTransitions(bytes);
}

template <class Message>
void CheckOne(const std::vector<std::byte>& bytes) {
  Message message{};
  if (!Decode(bytes, message)) {
    return;
  }
  std::vector<std::byte> again;
  Encode(message, again);
  FRESCO_CHECK(again == bytes);
  CheckContent(message);
  CheckPeeked(bytes, message);
}

using Check = void (*)(const std::vector<std::byte>&);

template <class... Message>
constexpr std::array<Check, sizeof...(Message)> ChecksOf(const std::tuple<Message...>*) {
  return {CheckOne<Message>...};
}

constexpr auto kChecks = ChecksOf(static_cast<const MessageTypes*>(nullptr));

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  if (size == 0) {
    return 0;
  }
  const auto rest = std::as_bytes(std::span(data + 1, size - 1));
  CheckUntrusted(rest);
  const auto check = kChecks[(data[0] & ~kOwnTrailer) % std::size(kChecks)];
  check((data[0] & kOwnTrailer) != 0 ? std::vector(rest.begin(), rest.end()) : WithTrailer(rest));
  return 0;
}
