#include "core/signals.h"

#include <gtest/gtest.h>

#include <csignal>

namespace fresco {
namespace {

TEST(StateSignal, IsTakenOnceHoweverOftenItCame) {
  StateSignal::Install();
  EXPECT_FALSE(StateSignal::TakeRequest());
  std::raise(SIGUSR1);
  std::raise(SIGUSR1);
  EXPECT_TRUE(StateSignal::TakeRequest());
  EXPECT_FALSE(StateSignal::TakeRequest());
  std::raise(SIGUSR1);
  EXPECT_TRUE(StateSignal::TakeRequest());
}

}  // namespace
}  // namespace fresco
