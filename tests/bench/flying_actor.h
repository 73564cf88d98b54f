// An actor's whole work but the bus's socket: it flies in as many environments as an actor has, with
// exploration, masks and temporal-difference errors, and encodes the messages. Every order has the same
// network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/clock.h"
#include "msgs/message_bus.h"
#include "msgs/order.h"
#include "training/flyer.h"

namespace fresco {

/// Not thread-safe.
class FlyingActor {
 public:
  /// `experiment` must outlive the object.
  explicit FlyingActor(const Experiment& experiment)
      : experiment_(&experiment),
        parameters_(std::make_shared<const Vector>(
            experiment.network()->InitialParameters(experiment.schedule().seed()))),
        flyer_(experiment, experiment.run().environments_per_actor()) {}

  /// Flies until as many episodes have ended as there are environments; returns their transitions. Starts the
  /// next one wherever one has ended.
  double Fly() {
    double transitions = 0;
    for (int ended = 0; ended < experiment_->run().environments_per_actor();) {
      while (flyer_.HasRoom()) {
        Order order;
        order.index = next_index_++;
        order.epsilon = 0.3;  // about the mean of the ladder
        order.seed = static_cast<uint64_t>(order.index);
        flyer_.Start(order, parameters_, parameters_);
      }
      flyer_.Step([&](const Order&, const OrderResult& result) {
        ++ended;
        transitions += result.episode.transitions();
        SplitResult(experiment_->world(), result, 1, [&](transitions_t& message) {
          Stamp(message, {1, experiment_->hash()}, WallMicroseconds());
          Encode(message, bytes_);
          encoded_bytes_ += static_cast<double>(bytes_.size());
        });
      });
    }
    transitions_ += transitions;
    return transitions;
  }

  /// Mean bytes of messages for a transition, of all so far.
  double bytes_per_transition() const { return encoded_bytes_ / transitions_; }

  const Vector& parameters() const { return *parameters_; }

 private:
  const Experiment* experiment_;
  SharedParameters parameters_;
  Flyer flyer_;
  int64_t next_index_ = 0;
  double transitions_ = 0;
  double encoded_bytes_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace fresco
