#include "tools/host_probe.h"

#include <unistd.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "core/clock.h"
#include "core/identifier.h"
#include "core/signals.h"
#include "core/utf8.h"
#include "msgs/channels.h"
#include "msgs/message_bus.h"

namespace fresco {
namespace {

constexpr size_t kMaximumActors = 1000;  // whatever is on the bus takes no more memory

/// The answers that have come.
class Answers {
 public:
  explicit Answers(int64_t series) : series_(series) {}

  void NoteSent(int64_t utime) { sent_utimes_.push_back(utime); }

  void Add(const probe_t& answer) {
    const bool possible = answer.run_id == series_ && answer.actor_id != 0 && answer.number >= 0 &&
                          static_cast<size_t>(answer.number) < sent_utimes_.size();
    if (!possible || (actors_.size() >= kMaximumActors && !actors_.contains(answer.actor_id))) {
      return;
    }
    const int64_t sent_utime = sent_utimes_[static_cast<size_t>(answer.number)];
    const int64_t now_utime = WallMicroseconds();
    ProbedActor& actor = actors_[answer.actor_id];
    actor.host = Printable(answer.host);
    actor.pid = answer.pid;
    actor.received = std::max(actor.received, answer.received);
    const double round_trip_ms = 1e-3 * static_cast<double>(now_utime - sent_utime);
    if (++actor.answers == 1 || round_trip_ms < actor.round_trip_ms) {
      actor.round_trip_ms = round_trip_ms;
      actor.clock_ahead_s =
          1e-6 * (static_cast<double>(answer.utime) - 0.5 * static_cast<double>(sent_utime + now_utime));
    }
  }

  /// Every actor sends statuses, whether it hears this host or not.
  void Add(const actor_status_t& status) {
    if (actors_.size() < kMaximumActors) {
      ProbedActor& actor = actors_[status.actor_id];
      actor.host = Printable(status.host);
      actor.pid = status.pid;
    }
  }

  std::vector<ProbedActor> Actors() const {
    std::vector<ProbedActor> actors;
    for (const auto& [id, actor] : actors_) {
      actors.push_back(actor);
    }
    std::sort(actors.begin(), actors.end(), [](const ProbedActor& a, const ProbedActor& b) {
      return std::tie(a.host, a.pid) < std::tie(b.host, b.pid);
    });
    return actors;
  }

 private:
  int64_t series_;
  std::vector<int64_t> sent_utimes_;
  std::map<int64_t, ProbedActor> actors_;
};

}  // namespace

ProbeResult ProbeActors(const ProbeOptions& options) {
  constexpr int64_t kLastAnswersUs = 500'000;
  const Channels channels = ChannelsWithPrefix(options.channel_prefix);
  const RunIdentity series{DrawIdentifier(), 0};
  const auto bus = OpenBus(options.lcm_url, {options.key_file});
  MessageBus messages(*bus);
  Answers answers(series.run_id);
  messages.Subscribe<probe_t>(channels.echo, [&](const probe_t& answer) { answers.Add(answer); });
  messages.Subscribe<actor_status_t>(channels.actor_status,
                                     [&](const actor_status_t& status) { answers.Add(status); });
  probe_t probe{};
  probe.pid = static_cast<int32_t>(getpid());
  probe.padding.resize(probe_t::MAXIMUM_PADDING_COUNT);
  probe.padding_count = probe_t::MAXIMUM_PADDING_COUNT;
  ProbeResult result;
  const int count = std::max(1, static_cast<int>(options.seconds * options.messages_per_s));
  const int64_t begin_us = MonotonicMicroseconds();
  const auto listen_until = [&](int64_t end_us) {
    do {
      bus->Poll(std::max<int64_t>(end_us - MonotonicMicroseconds(), 0));
    } while (MonotonicMicroseconds() < end_us && !StopSignal::Requested());
  };
  for (; result.sent < count && !StopSignal::Requested(); ++result.sent) {
    listen_until(begin_us + result.sent * int64_t{1'000'000} / options.messages_per_s);
    probe.number = result.sent;
    answers.NoteSent(WallMicroseconds());
    messages.Publish(channels.probe, probe, series);
  }
  result.sent_per_s = result.sent / (1e-6 * static_cast<double>(MonotonicMicroseconds() - begin_us));
  listen_until(MonotonicMicroseconds() + kLastAnswersUs);
  result.actors = answers.Actors();
  return result;
}

}  // namespace fresco
