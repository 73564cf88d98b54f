// Transitions, from bytes to the ledger. The first byte chooses the world (fuzzed_worlds.h). The rest is a
// sequence of encodings without trailer, each behind its length as two big-endian bytes. What FromWire lets
// through is in range; what the ledger commits is complete, and follows from its actions where it can be
// flown again.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzzed_worlds.h"
#include "training/ledger.h"

namespace fresco {
namespace {

constexpr size_t kLengthBytes = 2;

bool AreFinite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

/// Transitions of which each state has so many fields.
void CheckEpisode(const World& world, const Episode& episode, int fields) {
  const size_t count = episode.actions.size();
  FRESCO_CHECK(count >= 1 && episode.rewards.size() == count);
  FRESCO_CHECK(episode.states.size() == (count + 1) * static_cast<size_t>(fields));
  FRESCO_CHECK(episode.next_masks.size() == count * static_cast<size_t>(MaskSize(world.actions())));
  FRESCO_CHECK(AreFinite(episode.states) && AreFinite(episode.rewards));
  for (const int16_t action : episode.actions) {
    FRESCO_CHECK(action >= 0 && action < world.actions());
  }
}

void CheckPart(const World& world, const OrderResult& part) {
  const MessageLayout layout = LayoutOf(world);
  const int fields = std::min(layout.fields, world.state_size() - part.first_field);
  FRESCO_CHECK(part.first_field >= 0 && fields >= 1 && part.first_field % layout.fields == 0);
  CheckEpisode(world, part.episode, fields);
  FRESCO_CHECK(part.td_errors.size() == part.episode.actions.size() && AreFinite(part.td_errors));
  FRESCO_CHECK(part.first_transition >= 0 && part.order_index >= 0);
  FRESCO_CHECK(part.first_transition + part.episode.transitions() <= world.longest_episode());
}

void CheckCommitted(const World& world, const CommittedEpisode& committed) {
  CheckEpisode(world, committed.episode, world.state_size());
  FRESCO_CHECK(committed.episode.ending != Ending::kNone);
  FRESCO_CHECK(committed.episode.transitions() <= world.longest_episode());
  Episode flown;
  FRESCO_CHECK(!world.description().repeatable ||
               (FlyActions(world, committed.order.seed, committed.episode.actions, flown) &&
                SameBits(committed.episode, flown)));
}

/// The next encoding of the input, which it is cut off from; empty at the end.
std::span<const std::byte> NextEncoding(std::span<const std::byte>& input) {
  if (input.size() < kLengthBytes) {
    return {};
  }
  const size_t length = std::to_integer<size_t>(input[0]) << 8 | std::to_integer<size_t>(input[1]);
  const auto encoding = input.subspan(kLengthBytes, std::min(length, input.size() - kLengthBytes));
  input = input.subspan(kLengthBytes + encoding.size());
  return encoding;
}

void CheckAll(const World& world, std::span<const std::byte> input) {
  Ledger ledger(world);
  for (int64_t index = 0; index < kFuzzedOrders; ++index) {
    ledger.Write(FuzzedOrder(index));
  }
  transitions_t message{};
  OrderResult part;
  for (auto encoding = NextEncoding(input); !encoding.empty(); encoding = NextEncoding(input)) {
    if (Decode(WithTrailer(encoding), message) && FromWire(world, message, part)) {
      CheckPart(world, part);
      ledger.Add(part);
    }
  }
  while (const auto committed = ledger.TakeNext()) {
    CheckCommitted(world, *committed);
  }
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size > 0) {
    fresco::CheckAll(fresco::FuzzedWorld(data[0]), std::as_bytes(std::span(data + 1, size - 1)));
  }
  return 0;
}
