// Transitions, from bytes to the ledger, in the paper's world with three sensors. The input is a sequence
// of encodings without trailer, each behind its length as two big-endian bytes. What FromWire lets
// through is in range, and what the ledger commits follows from its actions.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "msgs/experiment.h"
#include "tests/fuzz/fuzz_input.h"
#include "training/ledger.h"

namespace fresco {
namespace {

constexpr int kOrders = 4;
constexpr size_t kLengthBytes = 2;

const World& PapersWorld() {
  static const World world(Experiment::Parse("", "the defaults").scenario());
  return world;
}

void CheckState(const World& world, const State& state) {
  FRESCO_CHECK(state.slot >= 1 && state.slot <= world.scenario().slots);
  FRESCO_CHECK(world.OnGrid(state.cell));
  FRESCO_CHECK(std::isfinite(state.energy_margin_j));
  FRESCO_CHECK(state.aoi.size() == static_cast<size_t>(world.sensors()));
  const auto [least, most] = std::minmax_element(state.aoi.begin(), state.aoi.end());
  FRESCO_CHECK(*least >= 1 && *most <= world.scenario().slots);
}

void CheckEpisode(const World& world, const Episode& episode) {
  const auto finite = [](float value) { return std::isfinite(value); };
  const size_t count = episode.actions.size();
  FRESCO_CHECK(count >= 1 && episode.states.size() == count + 1 && episode.rewards.size() == count);
  FRESCO_CHECK(episode.next_masks.size() == count * static_cast<size_t>(MaskSize(world)));
  for (const State& state : episode.states) {
    CheckState(world, state);
  }
  FRESCO_CHECK(std::all_of(episode.rewards.begin(), episode.rewards.end(), finite));
  for (const int16_t action : episode.actions) {
    FRESCO_CHECK(action >= 0 && action < world.actions());
  }
}

void CheckPart(const World& world, const OrderResult& part) {
  CheckEpisode(world, part.episode);
  FRESCO_CHECK(part.td_errors.size() == part.episode.actions.size());
  FRESCO_CHECK(part.first_transition >= 0 && part.order_index >= 0);
  FRESCO_CHECK(part.first_transition + part.episode.transitions() <= world.maximum_transitions());
  FRESCO_CHECK(std::all_of(part.td_errors.begin(), part.td_errors.end(),
                           [](float value) { return std::isfinite(value); }));
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

void CheckAll(std::span<const std::byte> input) {
  const World& world = PapersWorld();
  Ledger ledger(world, {});
  for (int64_t index = 0; index < kOrders; ++index) {
    ledger.Write({.index = index});
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
    CheckEpisode(world, committed->episode);
    Episode flown;
    FRESCO_CHECK(FlyActions(world, {}, committed->episode.actions, flown) &&
                 IsPartOf(committed->episode, 0, flown));
  }
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fresco::CheckAll(std::as_bytes(std::span(data, size)));
  return 0;
}
