// The learner's side of the bus, between the trainer and the actors: announces the run, hands out orders,
// collects transitions into the ledger, sends networks in paced chunks, reports status.
//
// Threads: Step belongs to one network thread, which never trains; every other function may be
// called from the training thread at the same time. One mutex guards the shared state; it is never
// held while sending.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "core/clock.h"
#include "learner/learner_report.h"
#include "learner/roster.h"
#include "learner/run_announcer.h"
#include "learner/weight_publisher.h"
#include "msgs/channels.h"
#include "msgs/message_bus.h"
#include "storage/summary.h"
#include "training/ledger.h"

namespace fresco {

class LearnerNode {
 public:
  /// Subscribes on `bus`, which must outlive the node.
  LearnerNode(const Experiment& experiment, int64_t run_id, Bus& bus, const Channels& channels);

  // ---- The training thread's side.
  void WriteOrder(const Order& order);
  void OfferVersion(NetworkVersion version, std::shared_ptr<const Vector> parameters);
  /// Replaces what the status says of the training.
  void Report(TrainingReport report);
  /// Waits up to `timeout_us` for the next episode by index.
  std::optional<CommittedEpisode> WaitForNext(int64_t timeout_us);

  // ---- The network thread's side.
  /// Handles what has arrived, waiting at most a fraction of a millisecond, and sends what is due.
  void Step();
  /// Announces, a few times, that the run is over.
  void AnnounceEnd();

  // ---- Any thread.
  BusCounters counters() const;
  /// Processor time of all actors while their statuses arrived here, microseconds.
  int64_t ActorProcessorMicroseconds() const;
  /// Continues counting from these: those of the same run before it was resumed.
  void RestoreCounters(const BusCounters& counters);
  /// What the trainer waits for, for whom and in which stage; empty: nothing.
  std::string WaitingFor() const;
  /// How long the trainer has waited for the next result; time in which this process was stopped does not
  /// count.
  double StarvedSeconds() const;
  /// A few lines for people: progress, actors and their orders, networks, counters.
  std::string StateText() const;
  /// The id of the run of another learner that was heard on the same channels, with a current time; 0: none.
  int64_t foreign_run() const;

 private:
  void HandleTransitions(const transitions_t& message);
  void HandleStatus(const actor_status_t& message);
  void HandleRun(const run_t& message);
  bool IsOurs(RunIdentity identity);
  void Reject(int64_t BusCounters::*cause);

  void SendRun(int64_t now_us, bool finished);
  void SendWorldIfDue(int64_t now_us);
  void SendOrders(int64_t now_us);
  void SendWeights(int64_t now_us);
  void SendStatusIfDue(int64_t now_us);
  learner_status_t Status(int64_t now_us);
  void WarnIfNeeded();
  std::string WaitingForLocked() const;
  double StarvedSecondsLocked() const;
  BusCounters CountersLocked() const;

  template <class Message>
  void Subscribe(const std::string& channel, void (LearnerNode::*handle)(const Message&));

  Experiment experiment_;
  MessageBus bus_;
  Channels channels_;
  RunIdentity identity_;
  int total_episodes_;

  mutable std::mutex mutex_;
  std::condition_variable next_is_complete_;
  Ledger ledger_;
  Roster roster_;
  WeightPublisher publisher_;
  BusCounters counters_;  // without those of the roster and the bus: see CountersLocked
  RunAnnouncer announcer_;
  TrainingReport report_;
  AttentiveClock clock_;          // of everything that is judged by time here
  int64_t waiting_since_us_ = 0;  // the trainer, for a result; 0: it does not wait

  // The network thread's own.
  StarvationWarning starvation_warning_;
  OrderResult part_;
  int64_t next_world_us_ = 0;
  int64_t next_orders_us_ = 0;
  int64_t next_status_us_ = 0;
  int64_t next_burst_us_ = 0;
  RateMeter transition_rate_;
  RateMeter update_rate_;
};

}  // namespace fresco
