// Which runs and episodes logs contain.
#include "logs/logged_episodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bus/authenticated_bus.h"
#include "bus/bus.h"
#include "core/bytes.h"
#include "core/error.h"
#include "nn/mlp.h"
#include "tests/logs/run_log.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using Ranges = std::vector<Interval>;

class LoggedEpisodesTest : public testing::Test {
 protected:
  LoggedEpisodes Open(const LogPaths& paths, std::optional<AuthenticationKey> key = {}) const {
    return {{paths, std::move(key)}, Identity(live_), live_.world};
  }

  LoggedEpisodes OpenLogOf(const std::vector<OwnedEvent>& events) const {
    WriteLog(folder_.path() / "log", events);
    return Open({folder_.path() / "log"});
  }

  /// Removes the transitions of these orders.
  void Remove(const std::set<int64_t>& orders) {
    std::erase_if(events_, [&](const OwnedEvent& event) {
      transitions_t message{};
      return Decode(event.message, message) && orders.contains(message.order_index);
    });
  }

  const TemporaryFolder folder_;
  const FinishedRun live_;
  std::vector<OwnedEvent> events_ = EventsOf(live_, Identity(live_));
};

TEST_F(LoggedEpisodesTest, HandsOutTheEpisodesThatWereFlown) {
  LoggedEpisodes episodes = OpenLogOf(events_);
  ASSERT_EQ(episodes.whole().size(), live_.episodes.size());
  for (size_t i = 3; i < live_.episodes.size(); i += 2) {
    const CommittedEpisode taken = episodes.Take(static_cast<int64_t>(i));
    EXPECT_TRUE(SameBits(taken.episode, live_.episodes[i]));
    EXPECT_EQ(taken.order.index, static_cast<int64_t>(i));
    EXPECT_EQ(taken.order.seed, live_.orders[i].seed);
  }
}

TEST_F(LoggedEpisodesTest, HandsOutEpisodesOfCartPoleWithTheirSeeds) {
  const FinishedRun run(SmallCartPole());
  WriteLog(folder_.path() / "log", EventsOf(run, Identity(run)));
  LoggedEpisodes episodes({{folder_.path() / "log"}}, Identity(run), run.world);
  ASSERT_EQ(episodes.whole().size(), run.episodes.size());
  std::set<Ending> endings;
  for (size_t i = 0; i < run.episodes.size(); ++i) {
    const CommittedEpisode taken = episodes.Take(static_cast<int64_t>(i));
    EXPECT_TRUE(SameBits(taken.episode, run.episodes[i]));
    EXPECT_EQ(taken.order.seed, run.orders[i].seed);
    endings.insert(taken.episode.ending);
  }
  EXPECT_EQ(endings, (std::set<Ending>{Ending::kTerminal, Ending::kTruncated}));
}

TEST_F(LoggedEpisodesTest, TakesNoEpisodeThatAnotherSeedBegins) {
  const FinishedRun run(SmallCartPole());
  std::vector<OwnedEvent> events = EventsOf(run, Identity(run));
  const auto forged = std::find_if(events.begin(), events.end(), [](const OwnedEvent& event) {
    return event.channel == "FRESCO_TRANSITIONS";
  });
  transitions_t message{};
  ASSERT_TRUE(Decode(forged->message, message));
  ++message.seed;
  Encode(message, forged->message);
  WriteLog(folder_.path() / "log", events);
  const LoggedEpisodes episodes({{folder_.path() / "log"}}, Identity(run), run.world);
  EXPECT_EQ(episodes.Missing(), (Ranges{{message.order_index, message.order_index}}));
}

TEST_F(LoggedEpisodesTest, NamesWhatIsMissingAsRanges) {
  Remove({0, 1, 2, 10, 20, 21});
  const LoggedEpisodes episodes = OpenLogOf(events_);
  EXPECT_EQ(episodes.Missing(), (Ranges{{0, 2}, {10, 10}, {20, 21}}));
}

TEST_F(LoggedEpisodesTest, PutsTogetherWhatSeveralRecordersHeard) {
  std::vector<OwnedEvent> even;
  std::vector<OwnedEvent> odd;
  for (size_t i = 0; i < events_.size(); ++i) {
    (i / 2 % 2 == 0 ? even : odd).push_back(events_[i]);
  }
  WriteLog(folder_.path() / "even", even);
  WriteLog(folder_.path() / "odd", odd);
  EXPECT_FALSE(Open({folder_.path() / "even"}).Missing().empty());
  LoggedEpisodes both = Open({folder_.path() / "odd", folder_.path() / "even"});
  EXPECT_EQ(both.whole().size(), live_.episodes.size());
  EXPECT_EQ(both.Take(7).episode.actions, live_.episodes[7].actions);
}

TEST_F(LoggedEpisodesTest, KnowsTrainingFromEvaluationByTheOrders) {
  WriteLog(folder_.path() / "log", events_);
  std::vector<int64_t> expected;
  for (const Order& order : live_.orders) {
    if (order.kind == OrderKind::kTrain) {
      expected.push_back(order.index);
    }
  }
  EXPECT_EQ(expected.size(), 60u);
  EXPECT_EQ(Open({folder_.path() / "log"}).Training(), expected);
  std::erase_if(events_, [](const OwnedEvent& event) { return event.channel == "FRESCO_ORDERS"; });
  WriteLog(folder_.path() / "without orders", events_);
  EXPECT_TRUE(Open({folder_.path() / "without orders"}).Training().empty());
}

TEST_F(LoggedEpisodesTest, ReadsAuthenticatedMessages) {
  for (OwnedEvent& event : events_) {
    event.message.insert(event.message.end(), kAuthenticationTagBytes, std::byte{7});
  }
  WriteLog(folder_.path() / "log", events_);
  EXPECT_EQ(Open({folder_.path() / "log"}).whole().size(), live_.episodes.size());
  EXPECT_EQ(FindLoggedRuns({{folder_.path() / "log"}}).size(), 1u);
}

/// Returns the same events as a bus with this key sends them.
std::vector<OwnedEvent> Authenticated(const std::vector<OwnedEvent>& events, const AuthenticationKey& key) {
  std::vector<OwnedEvent> authenticated;
  const std::unique_ptr<Bus> plain = OpenLcmBus("memq://");
  plain->SubscribeToAll([&](const LcmEvent& event) {
    authenticated.push_back({static_cast<int64_t>(authenticated.size()),
                             std::string(event.channel),
                             {event.message.begin(), event.message.end()}});
  });
  const std::unique_ptr<Bus> keyed = MakeAuthenticatedBus(*plain, key);
  for (const OwnedEvent& event : events) {
    keyed->Publish(event.channel, event.message);
    while (plain->Poll(1'000'000) == 0) {
    }
  }
  return authenticated;
}

TEST_F(LoggedEpisodesTest, TakesOnlyWhatIsAuthenticatedWhereThereIsAKey) {
  const AuthenticationKey key(std::vector<std::byte>(32, std::byte{1}));
  const AuthenticationKey other_key(std::vector<std::byte>(32, std::byte{2}));
  const size_t episodes = live_.episodes.size();
  std::vector<OwnedEvent> log = Authenticated(events_, key);
  log.insert(log.end(), events_.begin(), events_.end());
  WriteLog(folder_.path() / "log", log);
  const LoggedEpisodes authentic = Open({folder_.path() / "log"}, key);
  EXPECT_EQ(authentic.whole().size(), episodes);
  EXPECT_EQ(authentic.refused(), static_cast<int64_t>(events_.size()));
  const LoggedEpisodes strange = Open({folder_.path() / "log"}, other_key);
  EXPECT_TRUE(strange.whole().empty());
  EXPECT_EQ(strange.refused(), static_cast<int64_t>(log.size()));
}

TEST_F(LoggedEpisodesTest, HoldsNoMoreThanBoundedPiecesWhateverTheLogHolds) {
  // Pieces of 20,000 episodes that never become whole.
  const auto piece = std::find_if(events_.begin(), events_.end(), [](const OwnedEvent& event) {
    return event.channel == "FRESCO_TRANSITIONS";
  });
  transitions_t message{};
  ASSERT_TRUE(Decode(piece->message, message));
  message.ending = 0;
  std::vector<OwnedEvent> flood(20'000);
  for (size_t i = 0; i < flood.size(); ++i) {
    message.order_index = static_cast<int64_t>(i) * 1'000'000;
    flood[i] = {0, "FRESCO_TRANSITIONS", {}};
    Encode(message, flood[i].message);
  }
  flood.insert(flood.end(), events_.begin(), events_.end());
  LoggedEpisodes episodes = OpenLogOf(flood);
  EXPECT_EQ(episodes.Missing(), Ranges{});
  EXPECT_EQ(episodes.Take(30).episode.actions, live_.episodes[30].actions);
}

TEST_F(LoggedEpisodesTest, KnowsTheNetworksByTheirCrc) {
  const LoggedEpisodes episodes = OpenLogOf(events_);
  const Vector& last = *live_.current_versions.back();
  const auto version = static_cast<int32_t>(live_.current_versions.size() - 1);
  EXPECT_EQ(episodes.WeightsCrc(NetworkKind::kCurrent, version),
            Crc32c(std::span(last.data(), static_cast<size_t>(last.size()))));
  EXPECT_EQ(episodes.WeightsCrc(NetworkKind::kCurrent, version + 1), std::nullopt);
}

TEST_F(LoggedEpisodesTest, FindsTheRunsOfALogAndTheirConfiguration) {
  std::vector<OwnedEvent> others = EventsOf(live_, Identity(live_, 78));
  std::erase_if(others, [](const OwnedEvent& event) { return event.channel == "FRESCO_RUN"; });
  events_.insert(events_.end(), others.begin(), others.end());
  WriteLog(folder_.path() / "log", events_);
  const std::vector<LoggedRun> runs = FindLoggedRuns({{folder_.path() / "log"}});
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].identity, Identity(live_));
  EXPECT_EQ(runs[0].config_text, live_.experiment.Text());
  EXPECT_EQ(runs[0].arithmetic_fingerprint, ArithmeticFingerprint());
  EXPECT_EQ(runs[0].protocol_version, kProtocolVersion);
  EXPECT_GE(runs[0].transitions_messages, static_cast<int64_t>(live_.episodes.size()));
  EXPECT_EQ(runs[1].identity, Identity(live_, 78));
  EXPECT_EQ(runs[1].config_text, std::nullopt);

  EXPECT_EQ(ChooseLoggedRun(runs, "000000000000004e").identity.run_id, 78);
  EXPECT_THAT([&] { ChooseLoggedRun(runs, ""); },
              ThrowsMessage<Error>(testing::AllOf(HasSubstr("--run"), HasSubstr("000000000000004d"),
                                                  HasSubstr("000000000000004e"))));
  EXPECT_THAT([&] { ChooseLoggedRun(runs, "4f"); },
              ThrowsMessage<Error>(HasSubstr("does not contain run 4f")));
  EXPECT_THAT([] { ChooseLoggedRun({}, ""); }, ThrowsMessage<Error>(HasSubstr("no run of Fresco")));
}

TEST(LoggedRuns, OfAnotherReleaseAreNoRunsOfThisOne) {
  LoggedRun run;
  ExpectMessagesOfThisRelease(run);  // nothing was recorded that contradicts
  run.protocol_version = kProtocolVersion;
  ExpectMessagesOfThisRelease(run);
  run.protocol_version = kProtocolVersion - 1;
  EXPECT_THAT([&] { ExpectMessagesOfThisRelease(run); },
              ThrowsMessage<Error>(HasSubstr("protocol version " + std::to_string(kProtocolVersion - 1))));
}

}  // namespace
}  // namespace fresco
