// A roster with a ledger, for tests that give the time in microseconds.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "learner/roster.h"
#include "tests/training/literal_run.h"

namespace fresco {

inline constexpr int64_t kBeginUs = 1'000'000'000;

class RosterFixture : public ::testing::Test {
 protected:
  RosterFixture()
      : experiment_(SmallExperiment()),
        parameters_(std::make_shared<const Vector>(experiment_.network()->InitialParameters(1))),
        ledger_(experiment_.world()) {}

  void Write(int64_t orders) {
    for (; orders > 0; --orders) {
      Order order;
      order.index = ledger_.committed() + ledger_.in_flight();
      order.epsilon = 0.25;
      order.seed = 9 + static_cast<uint64_t>(order.index);
      order.current_version = 3;
      order.target_version = 2;
      ledger_.Write(order);
    }
  }

  static actor_status_t StatusOf(int64_t actor, int32_t capacity = 4) {
    actor_status_t status{};
    status.actor_id = actor;
    status.capacity = capacity;
    status.pid = static_cast<int32_t>(1000 + actor);
    status.host = "host-" + std::to_string(actor);
    status.oldest_open_order = -1;
    return status;
  }

  Roster::Hearing Hear(actor_status_t status, int64_t now_us) {
    status.sequence = next_sequence_++;
    return roster_.Hear(status, now_us);
  }
  Roster::Hearing Hear(int64_t actor, int64_t now_us, int32_t capacity = 4) {
    return Hear(StatusOf(actor, capacity), now_us);
  }

  /// The result of an order arrives, from an actor (0: from none that is known).
  void Complete(int64_t index, int64_t now_us, int64_t actor = 0) {
    ledger_.Add(FlyOrder(experiment_, ledger_.order(index), parameters_, parameters_));
    ASSERT_TRUE(ledger_.IsComplete(index));
    roster_.Completed(index, actor, now_us);
  }

  std::vector<order_t> Due(int64_t now_us) { return roster_.DueOrders(ledger_, now_us); }

  static int64_t CountOf(const std::vector<order_t>& orders, int64_t actor, int32_t attempt) {
    return std::count_if(orders.begin(), orders.end(), [&](const order_t& order) {
      return order.actor_id == actor && order.attempt == attempt;
    });
  }

  Experiment experiment_;
  std::shared_ptr<const Vector> parameters_;
  Ledger ledger_;
  Roster roster_;
  int64_t next_sequence_ = 0;
};

}  // namespace fresco
