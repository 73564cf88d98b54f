#include "tests/learner/forger.h"

#include "bus/authenticated_bus.h"
#include "msgs/message_bus.h"
#include "msgs/order.h"
#include "tests/training/literal_run.h"

namespace fresco {

Forger::Forger(const Experiment& experiment, const World& world, Bus& bus, const Channels& channels)
    : experiment_(&experiment), world_(&world), bus_(&bus), channels_(channels) {
  bus.Subscribe(channels.orders, [this](std::span<const std::byte> bytes) {
    orders_t message{};
    if (Decode(bytes, message) || (bytes.size() > kAuthenticationTagBytes &&
                                   Decode(bytes.first(bytes.size() - kAuthenticationTagBytes), message))) {
      Answer(message);
    }
  });
}

void Forger::Answer(const orders_t& message) {
  const auto zero =
      std::make_shared<const Vector>(Vector::Zero(experiment_->network_shape().parameter_count()));
  for (const order_t& wire : message.orders) {
    Order order;
    if (FromWire(wire, order)) {
      order.epsilon = 1;
      SplitResult(*world_, FlyOrder(*world_, *experiment_, order, zero, zero), wire.actor_id,
                  [&](const transitions_t& part) {
                    MessageBus(*bus_).Publish(channels_.transitions, part, IdentityOf(message));
                  });
    }
  }
}

}  // namespace fresco
