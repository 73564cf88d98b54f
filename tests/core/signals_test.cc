#include "core/signals.h"

#include <gtest/gtest.h>

#include <csignal>

namespace fresco {
namespace {

TEST(StateSignal, IsTakenOnceHoweverOftenItCame) {
  StateSignal::Install();
  EXPECT_FALSE(StateSignal::ConsumeRequest());
  std::raise(SIGUSR1);
  std::raise(SIGUSR1);
  EXPECT_TRUE(StateSignal::ConsumeRequest());
  EXPECT_FALSE(StateSignal::ConsumeRequest());
  std::raise(SIGUSR1);
  EXPECT_TRUE(StateSignal::ConsumeRequest());
}

}  // namespace
}  // namespace fresco
