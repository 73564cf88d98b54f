// The times of the protocol between learner and actors, in microseconds. They depend on each other, as the
// assertions say. Constants and a pure function; any thread may use them.
#pragma once

#include <cstdint>

namespace fresco {

// The learner sends:
inline constexpr int64_t kRunPeriodUs = 500'000;      ///< FRESCO_RUN, always
inline constexpr int64_t kAskedRunPeriodUs = 50'000;  ///< and at most so often if an actor asks for it
inline constexpr int64_t kWorldPeriodUs =
    1'000'000;  ///< FRESCO_WORLD and FRESCO_SCENARIO, the latter also from `fresco fly`
inline constexpr int64_t kLearnerStatusPeriodUs = 200'000;  ///< FRESCO_LEARNER_STATUS
inline constexpr int64_t kNewOrdersPeriodUs = 2'000;     ///< FRESCO_ORDERS, if an order is new or due again
inline constexpr int64_t kOrderRepeatPeriodUs = 60'000;  ///< an order without a complete result
inline constexpr int64_t kChunkBurstPeriodUs = 200;  ///< FRESCO_WEIGHTS_*, kChunksPerBurst chunks each time
inline constexpr int kChunksPerBurst = 8;            ///< complete even with Linux's default socket buffers
inline constexpr int64_t kChunkRepeatPeriodUs = 6'000;  ///< a chunk that was sent just now may be on its way

// An actor sends:
inline constexpr int64_t kActorStatusPeriodUs = 100'000;  ///< FRESCO_ACTOR_STATUS
inline constexpr int64_t kChunkRequestPeriodUs = 8'000;   ///< the same, if chunks are missing
inline constexpr int64_t kQuietVersionUs = 4'000;         ///< chunks are missing if none has come for so long
inline constexpr int64_t kResendPeriodUs = 50'000;        ///< an episode whose order is announced again

// What silence and age mean:
inline constexpr int64_t kSilentActorUs = 350'000;   ///< it gets no orders, and its own go to others
inline constexpr int64_t kGoneActorUs = 3'000'000;   ///< it counts as gone
inline constexpr int64_t kSilentRunUs = 10'000'000;  ///< an actor leaves the run
inline constexpr int64_t kFreeBusUs = 700'000;       ///< a bus is free if no run is heard for so long
/// So far behind the newest message of its learner, a message is a recorded one that somebody sends again.
inline constexpr int64_t kStaleUs = 1'000'000;
/// The clocks of hosts may differ by so much.
inline constexpr int64_t kClockToleranceUs = 10'000'000;

static_assert(kFreeBusUs > kRunPeriodUs, "a learner that listens for others hears one announcement at least");
static_assert(kSilentActorUs > 3 * kActorStatusPeriodUs,
              "several statuses may be lost before an actor is silent");
static_assert(kGoneActorUs > kSilentActorUs, "an actor is silent before it is gone");
static_assert(kOrderRepeatPeriodUs > kResendPeriodUs, "an order that is repeated is answered each time");
static_assert(kSilentRunUs > 10 * kRunPeriodUs,
              "many announcements may be lost before an actor leaves a run");
static_assert(kChunkRequestPeriodUs > kChunkRepeatPeriodUs, "a chunk that is asked for again is sent again");
static_assert(kChunkRequestPeriodUs > kQuietVersionUs, "a version is quiet before its chunks are asked for");
static_assert(kStaleUs > kRunPeriodUs, "a message may be late, but not by more than a recording");

/// Whether a learner's message of `utime` is current by the clock of this host, `now_utime`, both in
/// microseconds since the epoch. If not, it is a recording of an earlier run that somebody sends again.
inline bool IsCurrent(int64_t utime, int64_t now_utime) {
  return utime >= now_utime - kClockToleranceUs && utime <= now_utime + kClockToleranceUs;
}

}  // namespace fresco
