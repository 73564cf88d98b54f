// The learner's side of a bus, played by a test: publishes through the codecs of msgs/ and keeps what
// actors answer. One thread.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "actors/network_store.h"
#include "bus/bus.h"
#include "msgs/channels.h"
#include "tests/training/acting_samples.h"

namespace fresco {

class LearnerDouble {
 public:
  LearnerDouble(Bus& bus, const Channels& channels, const Experiment& experiment, int64_t run_id);

  /// The announcement's parts, changed by `change` (a lie, or the end of the run).
  void AnnounceRun(const std::function<void(run_t&)>& change = [](run_t&) {});
  std::vector<run_t> RunParts() const;
  void SendVersion(NetworkVersion version, const Vector& parameters, const std::set<int>& without = {});
  void SendOrders(const std::vector<order_t>& orders, int64_t committed = 0);

  /// Stamps with the run's identity, or another one, and publishes.
  template <class Message>
  void Send(const std::string& channel, Message message) {
    Send(channel, std::move(message), identity_);
  }
  template <class Message>
  void Send(const std::string& channel, Message message, RunIdentity identity) {
    Stamp(message, identity, utime_);
    std::vector<std::byte> bytes;
    Encode(message, bytes);
    bus_->Publish(channel, bytes);
  }

  /// When the messages from now on were sent, by the learner's clock.
  void SetClock(int64_t utime) { utime_ = utime; }
  RunIdentity identity() const { return identity_; }
  /// Complete results of this run in the order of their arrival, and who sent them.
  const std::vector<OrderResult>& results() const { return results_; }
  const std::set<int64_t>& senders() const { return senders_; }
  /// Statuses of every run and of none.
  const std::vector<actor_status_t>& statuses() const { return statuses_; }

 private:
  void TakeTransitions(const transitions_t& message);

  Bus* bus_;
  Channels channels_;
  Experiment experiment_;
  World world_;
  RunIdentity identity_;
  int64_t utime_ = 1;
  OrderResult open_;  // the result whose parts are arriving
  std::vector<OrderResult> results_;
  std::set<int64_t> senders_;
  std::vector<actor_status_t> statuses_;
};

}  // namespace fresco
