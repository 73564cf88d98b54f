// Transitions, from bytes to the ledger, in the paper's world with three sensors. The input is a sequence
// of encodings without trailer, each behind its length as two big-endian bytes. What ToEpisodeRun lets
// through is in range, and what the ledger commits follows from its actions.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "msgs/experiment.h"
#include "tests/fuzz/fuzz_input.h"
#include "training/episode_check.h"
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

void CheckRun(const World& world, const Episode& run) {
  const auto finite = [](float value) { return std::isfinite(value); };
  const size_t count = run.actions.size();
  FRESCO_CHECK(count >= 1 && run.states.size() == count + 1);
  FRESCO_CHECK(run.rewards.size() == count && run.td_errors.size() == count);
  FRESCO_CHECK(run.next_masks.size() == count * static_cast<size_t>(MaskSize(world)));
  FRESCO_CHECK(run.first_transition >= 0 && run.order_index >= 0);
  FRESCO_CHECK(run.first_transition + run.transitions() <= world.maximum_transitions());
  for (const State& state : run.states) {
    CheckState(world, state);
  }
  FRESCO_CHECK(std::all_of(run.rewards.begin(), run.rewards.end(), finite));
  FRESCO_CHECK(std::all_of(run.td_errors.begin(), run.td_errors.end(), finite));
  for (const int16_t action : run.actions) {
    FRESCO_CHECK(action >= 0 && action < world.actions());
  }
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
  Episode run;
  for (auto encoding = NextEncoding(input); !encoding.empty(); encoding = NextEncoding(input)) {
    if (Decode(WithTrailer(encoding), message) && ToEpisodeRun(world, message, run)) {
      CheckRun(world, run);
      ledger.Add(run);
    }
  }
  while (const auto committed = ledger.TakeNext()) {
    CheckRun(world, committed->episode);
    Episode flown;
    FRESCO_CHECK(FlyActions(world, {}, committed->episode.actions, flown) &&
                 IsPartOf(committed->episode, flown));
  }
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fresco::CheckAll(std::as_bytes(std::span(data, size)));
  return 0;
}
