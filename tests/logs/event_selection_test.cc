// Which events the subcommands of `fresco log` select.
#include "logs/event_selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/msgs/message_samples.h"
#include "tests/support/error_of.h"

namespace fresco {
namespace {

constexpr int64_t kRunId = 0x123456789abcdef0;

actor_status_t StatusOf(int64_t run_id) {
  RandomStream stream(9, RandomPurpose::kTest, 2, 0);
  actor_status_t message = ActorStatusOf(stream, 1, 2, 5);
  Stamp(message, {run_id, 0xcafe0001}, 1);
  return message;
}

TEST(EventSelection, TakesTimesFromTheFirstEventAndEndsBeforeTheStop) {
  EventSelection selection({.start_s = 1, .stop_s = 2});
  const std::vector<std::byte> bytes;
  std::string wanted;
  for (const int64_t utime : {5'000'000, 5'999'999, 6'000'000, 6'999'999, 7'000'000}) {
    wanted += selection.Wants({0, utime, "A", bytes}) ? '1' : '0';
  }
  EXPECT_EQ(wanted, "00110");
}

TEST(EventSelection, KeepsEventsFromBeforeTheFirstOneIfNoStartIsAskedFor) {
  EventSelection selection({.stop_s = 2});
  EXPECT_TRUE(selection.Wants({0, 5'000'000, "A", {}}));
  EXPECT_TRUE(selection.Wants({0, 4'000'000, "A", {}}));
  EXPECT_FALSE(selection.Wants({0, 7'000'000, "A", {}}));
}

TEST(EventSelection, DropsOtherRunsOnly) {
  EventSelection selection({.run = "123456789abcdef0"});
  const std::vector<std::byte> foreign(100);
  EXPECT_TRUE(selection.Wants({0, 1, "A", Encoded(StatusOf(kRunId))}));
  EXPECT_FALSE(selection.Wants({0, 1, "A", Encoded(StatusOf(5))}));
  EXPECT_TRUE(selection.Wants({0, 1, "A", Encoded(StatusOf(0))}));
  EXPECT_TRUE(selection.Wants({0, 1, "A", foreign}));
}

TEST(ChannelFilter, NamesTheOptionOfWhatIsNoExpression) {
  EXPECT_THAT(ErrorOf([] {
                ChannelFilter({"A", "FRESCO_["}, "--channel");
              }),
              testing::AllOf(testing::HasSubstr("--channel"), testing::HasSubstr("FRESCO_[")));
}

}  // namespace
}  // namespace fresco
