// An actor: finds a run on the bus, serves it (actors/served_run.h), and reports its status to the learner.
// When a run is over, it serves the next one. Everything happens on the one thread that calls Step.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actors/served_run.h"
#include "bus/bus.h"
#include "core/clock.h"
#include "core/memory.h"
#include "msgs/channels.h"
#include "msgs/message_bus.h"
#include "msgs/run_announcements.h"

namespace fresco {

struct ActorOptions {
  int64_t actor_id = 1;  ///< unique among the actors of a bus; never 0
  int64_t run_id = 0;    ///< serve this run only; 0: any
  /// Files with code that is not Fresco's (plug-ins, Python modules) that a run may make this actor run.
  std::vector<std::filesystem::path> allowed_code = {};
  std::optional<int> capacity;  ///< environments; none: as the run's configuration says
  std::string host;
  int32_t pid = 0;
  std::function<int64_t()> clock_us = MonotonicMicroseconds;  ///< when a message arrives
  std::function<int64_t()> wall_clock_us = WallMicroseconds;  ///< to tell recordings of earlier runs
  /// A run whose configuration takes more is refused.
  std::function<AvailableMemory()> available_memory = [] { return ReadAvailableMemory(); };
};

/// Messages, by cause.
struct RejectedMessages {
  int64_t malformed = 0;        ///< not a message of this type, or damaged
  int64_t foreign = 0;          ///< of another run or configuration
  int64_t stale = 0;            ///< of the learner, but recorded and sent again
  int64_t inconsistent = 0;     ///< orders or chunks that contradict the run or each other
  int64_t unauthenticated = 0;  ///< by the bus
  int64_t total() const { return malformed + foreign + stale + inconsistent + unauthenticated; }
};

struct ActorTotals {
  int64_t runs = 0;
  int64_t episodes = 0;
  int64_t transitions = 0;
  int64_t resent_episodes = 0;
  int64_t completed_versions = 0;
  int64_t longest_assembly_us = 0;  ///< of a version, from its first chunk until it was complete
  int64_t received_messages = 0;    ///< of the runs served
  RejectedMessages rejected = {};
};

class Actor {
 public:
  /// Subscribes. `bus` must outlive the actor; it may be shared in a test with other nodes, so
  /// the caller polls it.
  Actor(Bus& bus, const Channels& channels, ActorOptions options);

  /// Flies one slot of every open order and sends what is due. Returns whether there is more to fly
  /// at once; otherwise the caller may wait for the bus.
  bool Step(int64_t now_us);

  ActorTotals totals() const;
  bool has_run() const { return run_ != nullptr; }
  /// Whether the run that it last served has ended.
  bool run_over() const { return run_over_; }
  /// The last line of the log: what it did in its life.
  std::string Description() const;
  /// For people, a few lines: the run, what every open order waits for, networks, totals.
  std::string StateText() const;

 private:
  void HandleRun(const run_t& message);
  void HandleOrders(const orders_t& message);
  void HandleProbe(const probe_t& probe);
  template <NetworkKind kind>
  void HandleWeights(const weights_t& message);
  bool IsMine(RunIdentity identity, int64_t utime);
  bool WouldLeaveFor(const run_t& other) const;
  void Join(const run_t& message, const std::string& text);
  void RefuseOtherCode(const std::string& code) const;
  void NoteRefusal(int64_t run_id, const char* reason);
  void LeaveSilentRun();
  void Send(const OrderResult& result, bool again);
  void SendStatusIfDue(int64_t now_us);
  actor_status_t Status(int64_t now_us);

  template <class Message>
  void Subscribe(const std::string& channel, void (Actor::*handle)(const Message&));

  MessageBus bus_;
  Channels channels_;
  ActorOptions options_;
  uint32_t arithmetic_fingerprint_;
  ActorTotals totals_;  // without what the bus refused
  RunAnnouncements announcements_;
  std::unique_ptr<ServedRun> run_;  // null: it waits for one
  bool run_over_ = false;
  int64_t refused_run_ = 0;  // the last run that this actor can't serve: said once
  int64_t next_refusal_us_ = 0;
  int64_t now_us_ = 0;
  AttentiveClock attention_;
  int64_t next_sequence_ = 0;  // of the statuses
  int64_t next_status_us_ = 0;
  int64_t next_request_us_ = 0;
  RateMeter rate_;  // of the transitions
  struct ProbeSeries {
    int64_t run_id = 0;
    int32_t received = 0;
  };
  std::array<ProbeSeries, 8> probes_;  // of the doctors that asked last
  size_t next_probes_ = 0;             // for the next doctor
  int64_t echo_second_ = 0;            // of the last answer to a probe
  int echoes_ = 0;                     // sent in this second
};

}  // namespace fresco
