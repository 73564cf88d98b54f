// The bus between learner and actors, beside bare LCM, with the same sockets: Linux's default buffers, one
// host.
//
// bus_transitions: four real processes fresco-actor fly quick's world with a network of eight units, and a
// real learner node and trainer take their episodes: ledger, check, replay memory. The trainer makes no
// update, so nothing waits for it, and 128 episodes are in flight, so that every environment has one.
// Everything else is as in a run: orders, repeated announcements, messages. The rate is that of the
// transitions committed, in sequence, so none of them is lost; it includes the processor time of the flights
// and of the learner's check. The reference is four processes that publish messages of the same size with
// lcm_publish, and one that counts what lcm_handle brings; nobody looks into them, and those that are lost
// are lost. Of several pauses between the messages, the best counts.
//
// bus_ledger: the same without the flights: the four processes answer every order at once with an episode
// flown beforehand. This is what the messages, the ledger, its check and the replay memory take. 1,024
// episodes are in flight, since the learner sends orders every 2 ms.
//
// growth_actors_*: bus_ledger with so many actors, which the four processes play; beside four.
//
// weights_delivery_ms: the same learner, with four actors and quick's network. While they fly, the trainer's
// side offers one version after the other; the time is that from the offer until the last of the four has the
// complete version. The reference is the same bytes as one message by lcm_publish to four processes that wait
// for it, in turns with the versions, while the same actors fly.
#include <fmt/format.h>
#include <lcm/lcm.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <optional>
#include <stop_token>
#include <thread>

#include "actors/actor.h"
#include "bus/bus.h"
#include "core/child_process.h"
#include "core/clock.h"
#include "core/installation.h"
#include "learner/learner_node.h"
#include "msgs/message_bus.h"
#include "msgs/order.h"
#include "msgs/protocol_times.h"
#include "msgs/ready_experiments.h"
#include "nn/mlp.h"
#include "tests/bench/forked.h"
#include "tests/bench/stop.h"
#include "tests/bench/subjects.h"
#include "training/flyer.h"
#include "training/trainer.h"

namespace fresco {
namespace {

constexpr size_t kActors = 4;
constexpr int64_t kRunId = 1;
constexpr char kRunUrl[] = "udpm://239.255.76.67:7881?ttl=0";
constexpr char kBareUrl[] =
    "udpm://239.255.76.67:7882?ttl=0&recv_buf_size=4194304";  // as OpenLcmBus makes it
constexpr char kBareChannel[] = "BARE";
constexpr double kSecondsPerMicrosecond = 1e-6;
/// Pauses of the bare senders. The learner gets as many windows of time as they do.
constexpr int64_t kPausesUs[] = {0, 20, 50, 100, 200};
constexpr int kWindows = std::size(kPausesUs);

Experiment ExperimentWithoutUpdates(Settings more) {
  Settings settings = {{"schedule.minimum_replay_size", "100000000"},
                       {"schedule.episodes", "4000000000"},
                       {"run.lcm_url", kRunUrl}};
  settings.insert(settings.end(), more.begin(), more.end());
  return Experiment::Load(ExperimentPath(kDefaultExperiment), settings);
}

/// A learner that commits episodes but makes no updates.
class CommittingLearner {
 public:
  explicit CommittingLearner(const Experiment& experiment)
      : bus_(OpenLcmBus(kRunUrl)),
        node_(experiment, kRunId, *bus_, ChannelsWithPrefix(experiment.run().channel_prefix())),
        trainer_(experiment, Output()) {
    trainer_.Begin();
    network_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        node_.Step();
      }
      node_.AnnounceEnd();
    });
  }

  /// Commits what arrives for so long; returns the transitions committed.
  int64_t Commit(double seconds) {
    const int64_t begin = trainer_.progress().transitions;
    const int64_t end_us = MonotonicMicroseconds() + static_cast<int64_t>(seconds / kSecondsPerMicrosecond);
    for (int64_t now_us = 0; (now_us = MonotonicMicroseconds()) < end_us;) {
      if (const auto next = node_.WaitForNext(std::min<int64_t>(end_us - now_us, 1'000))) {
        trainer_.Commit(next->order, std::move(next->episode));
      }
    }
    ThrowIfStopped();
    return trainer_.progress().transitions - begin;
  }

  LearnerNode& node() { return node_; }
  const Trainer& trainer() const { return trainer_; }

 private:
  TrainerOutput Output() {
    TrainerOutput output;
    output.order = [this](const Order& order) { node_.WriteOrder(order); };
    output.version = [this](NetworkVersion version, std::shared_ptr<const Vector> parameters) {
      node_.OfferVersion(version, std::move(parameters));
    };
    output.evaluation = [](const Evaluation&) {};
    return output;
  }

  std::unique_ptr<Bus> bus_;
  LearnerNode node_;
  Trainer trainer_;
  std::jthread network_;
};

struct DestroyLcm {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};
using BareLcm = std::unique_ptr<lcm_t, DestroyLcm>;

BareLcm OpenBareLcm() {
  BareLcm lcm(lcm_create(kBareUrl));
  if (lcm == nullptr) {
    throw Failure(fmt::format("LCM can't open {}", kBareUrl));
  }
  return lcm;
}

/// Four processes that publish messages of `bytes` with a pause between them.
class BareSenders {
 public:
  BareSenders(size_t bytes, int64_t pause_us)
      : processes_(kActors, [=](size_t) {
          const BareLcm lcm = OpenBareLcm();
          const std::vector<uint8_t> message(bytes, 1);
          for (int64_t next_us = MonotonicMicroseconds();; next_us += pause_us) {
            while (pause_us > 0 && MonotonicMicroseconds() < next_us) {
              std::this_thread::sleep_for(std::chrono::microseconds(next_us - MonotonicMicroseconds()));
            }
            lcm_publish(lcm.get(), kBareChannel, message.data(), static_cast<unsigned>(message.size()));
          }
        }) {}

 private:
  ForkedProcesses processes_;
};

/// Messages a second that lcm_handle brings while four processes publish.
double BareMessagesPerSecond(size_t bytes, int64_t pause_us, double seconds) {
  const BareSenders senders(bytes, pause_us);
  const BareLcm lcm = OpenBareLcm();
  int64_t received = 0;
  lcm_subscription_t* subscription = lcm_subscribe(
      lcm.get(), kBareChannel,
      [](const lcm_recv_buf_t*, const char*, void* count) { ++*static_cast<int64_t*>(count); }, &received);
  FRESCO_CHECK(subscription != nullptr);
  lcm_subscription_set_queue_capacity(subscription, kDefaultQueueCapacity);
  while (received < 100) {  // all have started
    FRESCO_CHECK(lcm_handle(lcm.get()) == 0);
  }
  received = 0;
  const int64_t begin_us = MonotonicMicroseconds();
  double elapsed_s = 0;
  while (elapsed_s < seconds) {
    FRESCO_CHECK(lcm_handle_timeout(lcm.get(), 10) >= 0);
    elapsed_s = static_cast<double>(MonotonicMicroseconds() - begin_us) * kSecondsPerMicrosecond;
  }
  ThrowIfStopped();
  return static_cast<double>(received) / elapsed_s;
}

/// The messages of one episode: their mean size on the wire, and the mean number of transitions in each.
struct EpisodeMessages {
  size_t bytes = 0;
  double transitions = 0;
};

EpisodeMessages MessagesOfEpisode(const World& world) {
  const auto count = static_cast<size_t>(world.longest_episode());
  Episode episode;
  episode.states.resize((count + 1) * static_cast<size_t>(world.state_size()));
  episode.actions.resize(count);
  episode.rewards.resize(count);
  episode.next_masks.resize(count * static_cast<size_t>(MaskSize(world.actions())));
  size_t messages = 0;
  size_t all_bytes = 0;
  std::vector<std::byte> bytes;
  SplitResult(world, {0, 0, 0, 0, episode, std::vector<float>(count)}, 1, [&](const transitions_t& message) {
    Encode(message, bytes);
    ++messages;
    all_bytes += bytes.size();
  });
  return {all_bytes / messages, static_cast<double>(count) / static_cast<double>(messages)};
}

/// The rate at which the learner commits, after the first episodes, in the fastest of several windows of
/// `seconds`.
double CommittedPerSecond(CommittingLearner& learner, double seconds) {
  constexpr int64_t kWarmUpTransitions = 20'000;
  constexpr double kTurnS = 0.05;
  constexpr int kMostTurns = 600;
  for (int turn = 0; learner.trainer().progress().transitions < kWarmUpTransitions; ++turn) {
    if (turn == kMostTurns) {
      throw Failure("the actors sent too little in half a minute");
    }
    learner.Commit(kTurnS);
  }
  double fastest = 0;
  for (int window = 0; window < kWindows; ++window) {
    const int64_t begin_us = MonotonicMicroseconds();
    const auto transitions = static_cast<double>(learner.Commit(seconds));
    const auto elapsed_us = static_cast<double>(MonotonicMicroseconds() - begin_us);
    fastest = std::max(fastest, transitions / (elapsed_us * kSecondsPerMicrosecond));
  }
  return fastest;
}

/// Four real actors.
double FlownPerSecond(double seconds) {
  const Experiment experiment = ExperimentWithoutUpdates(
      {{"agent.hidden_layers", "8"}, {"schedule.window", "128"}, {"schedule.excursion_share", "0"}});
  CommittingLearner learner(experiment);
  std::vector<std::unique_ptr<ChildProcess>> actors;
  for (size_t i = 0; i < kActors; ++i) {
    actors.push_back(std::make_unique<ChildProcess>(
        std::vector<std::string>{SiblingProgram("fresco-actor").string(), "--lcm-url", kRunUrl, "--once"},
        std::filesystem::path("/dev/null")));
  }
  return CommittedPerSecond(learner, seconds);
}

/// Answers the learner's orders to every fourth actor of `actors` from the first one on, each at once and
/// with the same episode.
void AnswerOrders(const Experiment& experiment, size_t first, size_t actors, const Episode& episode) {
  const std::unique_ptr<Bus> lcm = OpenLcmBus(kRunUrl);
  MessageBus bus(*lcm);
  const Channels channels = ChannelsWithPrefix(kDefaultChannelPrefix);
  const RunIdentity identity{kRunId, experiment.hash()};
  OrderResult result;
  result.episode = episode;
  result.td_errors.resize(episode.actions.size());
  bus.Subscribe<orders_t>(channels.orders, [&](const orders_t& message) {
    Order order;
    for (const order_t& wire : message.orders) {
      if (static_cast<size_t>(wire.actor_id) % kActors == first && FromWire(wire, order)) {
        result.order_index = order.index;
        result.seed = order.seed;
        SplitResult(experiment.world(), result, wire.actor_id,
                    [&](transitions_t& part) { bus.Publish(channels.transitions, part, identity); });
      }
    }
  });
  actor_status_t status{};
  status.capacity = static_cast<int32_t>(experiment.schedule().window());
  status.arithmetic_fingerprint = ArithmeticFingerprint();
  status.oldest_open_order = -1;
  for (int64_t next_us = 0;;) {
    if (const int64_t now_us = MonotonicMicroseconds(); now_us >= next_us) {
      next_us = now_us + kActorStatusPeriodUs;
      for (status.actor_id = static_cast<int64_t>(first + kActors);
           status.actor_id < static_cast<int64_t>(actors + kActors); status.actor_id += kActors) {
        bus.Publish(channels.actor_status, status, identity);
      }
      ++status.sequence;
    }
    bus.Poll(kActorStatusPeriodUs);
  }
}

/// So many actors that answer without flying, in up to four processes.
double AnsweredPerSecond(size_t actors, double seconds) {
  const Experiment experiment =
      ExperimentWithoutUpdates({{"agent.hidden_layers", "8"}, {"schedule.window", "1024"}});
  const auto network =
      std::make_shared<const Vector>(experiment.network()->InitialParameters(experiment.schedule().seed()));
  const Episode episode = FlyGreedily(experiment, 0, network);  // the field is the same in all of them
  const ForkedProcesses processes(std::min(actors, kActors),
                                  [&](size_t first) { AnswerOrders(experiment, first, actors, episode); });
  CommittingLearner learner(experiment);
  return CommittedPerSecond(learner, seconds);
}

Results BusTransitions(double seconds) {
  constexpr int kRounds = 3;
  const Experiment experiment = Experiment::Load(ExperimentPath(kDefaultExperiment), {});
  const EpisodeMessages messages = MessagesOfEpisode(experiment.world());
  const double window_s = seconds / 10;  // long beside the time that queues and orders in flight last
  double flown = 0;
  double answered = 0;
  double bare = 0;
  int64_t best_pause_us = 0;
  for (int round = 0; round < kRounds; ++round) {
    flown = std::max(flown, FlownPerSecond(window_s));
    answered = std::max(answered, AnsweredPerSecond(kActors, window_s));
    for (const int64_t pause_us : kPausesUs) {
      const double rate = BareMessagesPerSecond(messages.bytes, pause_us, window_s);
      if (rate > bare) {
        bare = rate;
        best_pause_us = pause_us;
      }
    }
  }
  const std::string reference = fmt::format(
      "bare LCM from four processes in messages of the same size ({} bytes, {:.0f} "
      "transitions); one each {} us from each process was the best",
      messages.bytes, messages.transitions, best_pause_us);
  return {{MoreIsBetter("bus_transitions", flown, "transitions/s", reference, bare * messages.transitions),
           MoreIsBetter("bus_ledger", answered, "transitions/s", reference, bare * messages.transitions)},
          {}};
}

Subject GrownActors(size_t actors) {
  const std::string name = fmt::format("growth_actors_{}", actors);
  return {{name}, [=](double seconds) -> Results {
            constexpr int kRounds = 3;
            const double window_s = seconds / 10;
            double grown = 0;
            double usual = 0;
            for (int round = 0; round < kRounds; ++round) {
              grown = std::max(grown, AnsweredPerSecond(actors, window_s));
              usual = std::max(usual, AnsweredPerSecond(kActors, window_s));
            }
            return {{MoreIsBetter(name, grown, "transitions/s", "four actors", usual)}, {}};
          }};
}

/// What an actor, or a bare receiver, tells of the last version or message that it has.
struct Arrival {
  std::atomic<int64_t> number = 0;  ///< 1, 2, ..
  std::atomic<int64_t> at_us = 0;   ///< written before `number`
  void Note(int64_t new_number) {
    at_us = MonotonicMicroseconds();
    number = new_number;
  }
};
using Arrivals = SharedObjects<Arrival>;

/// The loop of fresco-actor, which notes when a version is complete.
void ServeAndNote(size_t number, Arrival& arrival) {
  spdlog::set_level(spdlog::level::err);
  const std::unique_ptr<Bus> bus = OpenLcmBus(kRunUrl);
  ActorOptions options;
  options.actor_id = static_cast<int64_t>(number) + 1;
  Actor actor(*bus, ChannelsWithPrefix(kDefaultChannelPrefix), options);
  for (;;) {
    constexpr int64_t kWaitUs = 2'000;
    const bool busy = actor.Step(MonotonicMicroseconds());
    bus->Poll(busy ? 0 : kWaitUs);
    if (const int64_t completed = actor.totals().completed_versions; completed != arrival.number) {
      arrival.Note(completed);
    }
  }
}

void ReceiveAndNote(Arrival& arrival) {
  const BareLcm lcm = OpenBareLcm();
  FRESCO_CHECK(lcm_subscribe(
                   lcm.get(), kBareChannel,
                   [](const lcm_recv_buf_t* buffer, const char*, void* user) {
                     int64_t number = 0;
                     std::memcpy(&number, buffer->data, sizeof number);
                     static_cast<Arrival*>(user)->Note(number);
                   },
                   &arrival) != nullptr);
  while (lcm_handle(lcm.get()) == 0) {
  }
}

/// Waits until all four have this number; the learner commits meanwhile. Returns the time of the last; none
/// if that takes longer than a quarter of a second.
std::optional<int64_t> LastArrival(Arrivals& arrivals, int64_t number, CommittingLearner& learner) {
  constexpr double kTurnS = 0.001;
  constexpr int kTurns = 250;
  for (int turn = 0; turn < kTurns; ++turn) {
    learner.Commit(kTurnS);
    bool all = true;
    int64_t last_us = 0;
    for (size_t i = 0; i < kActors; ++i) {
      all = all && arrivals[i].number >= number;
      last_us = std::max<int64_t>(last_us, arrivals[i].at_us);
    }
    if (all) {
      return last_us;
    }
  }
  return std::nullopt;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<int64_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Results WeightsDelivery(double seconds) {
  constexpr double kMillisecondsPerMicrosecond = 1e-3;
  const Experiment experiment = ExperimentWithoutUpdates({});
  Arrivals versions(kActors);
  Arrivals messages(kActors);
  const ForkedProcesses actors(kActors, [&](size_t i) { ServeAndNote(i, versions[i]); });
  const ForkedProcesses receivers(kActors, [&](size_t i) { ReceiveAndNote(messages[i]); });
  CommittingLearner learner(experiment);
  const BareLcm lcm = OpenBareLcm();
  const auto parameters = std::make_shared<const Vector>(learner.trainer().current());
  std::vector<std::byte> message(static_cast<size_t>(parameters->size()) * sizeof(float));
  constexpr int64_t kFirstVersions = 2;  // version 0 of both networks
  constexpr int kMostTurns = 100;
  for (int turn = 0; !LastArrival(versions, kFirstVersions, learner); ++turn) {
    if (turn == kMostTurns) {
      throw Failure("weights_delivery_ms: the actors did not get the first networks in half a minute");
    }
  }
  learner.Commit(0.3);  // until all are flying
  std::vector<double> delivery_ms;
  std::vector<double> bare_ms;
  int32_t version = 0;
  const int64_t end_us = MonotonicMicroseconds() + static_cast<int64_t>(seconds / kSecondsPerMicrosecond);
  while (MonotonicMicroseconds() < end_us || delivery_ms.empty()) {
    const int64_t offer_us = MonotonicMicroseconds();
    learner.node().OfferVersion({NetworkKind::kCurrent, ++version}, parameters);
    const auto last_us = LastArrival(versions, kFirstVersions + version, learner);
    if (!last_us) {
      throw Failure("weights_delivery_ms: a version did not arrive within a quarter of a second");
    }
    delivery_ms.push_back(kMillisecondsPerMicrosecond * static_cast<double>(*last_us - offer_us));
    const int64_t publish_us = MonotonicMicroseconds();
    const int64_t number = version;
    std::memcpy(message.data(), &number, sizeof number);
    lcm_publish(lcm.get(), kBareChannel, message.data(), static_cast<unsigned>(message.size()));
    if (const auto received_us = LastArrival(messages, number, learner)) {
      bare_ms.push_back(kMillisecondsPerMicrosecond * static_cast<double>(*received_us - publish_us));
    }
  }
  if (bare_ms.empty()) {
    return AllAbsent({"weights_delivery_ms"}, "bare LCM lost every message of a network's size");
  }
  return {
      {LessIsBetter("weights_delivery_ms", Median(delivery_ms), "ms",
                    fmt::format("the same {} bytes as one message of bare LCM, of which {} of {} reached all "
                                "four; both are medians",
                                message.size(), bare_ms.size(), version),
                    Median(bare_ms))},
      {}};
}

}  // namespace

std::vector<Subject> BusSubjects() {
  return {{{"bus_transitions", "bus_ledger"}, BusTransitions},
          {{"weights_delivery_ms"}, WeightsDelivery},
          GrownActors(1),
          GrownActors(16),
          GrownActors(64)};
}

}  // namespace fresco
