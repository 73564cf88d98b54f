#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/lcm_url.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/help_formatter.h"
#include "core/identifier.h"
#include "core/installation.h"
#include "core/memory.h"
#include "msgs/channels.h"
#include "nn/arithmetic.h"
#include "tools/host_probe.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

enum class Health { kGood, kWarning, kFailure };

/// What one check found.
struct Finding {
  std::string name;
  Health health = Health::kGood;
  std::string found;
  std::string command = {};  ///< mends it; empty if nothing has to be mended
};

// For Debian's table of rules, /etc/nftables.conf. As the first rule, so that no other one drops it before.
constexpr char kAcceptMulticast[] = "nft insert rule inet filter input ip daddr 224.0.0.0/4 accept";

struct DoctorOptions {
  std::string lcm_url = kDefaultLcmUrl;
  std::string channel_prefix = kDefaultChannelPrefix;
  std::string folder = ".";
  std::string format = "text";
  bool hosts = false;
  ProbeOptions probe{};  // its URL and prefix are those above
};

/// A UDP socket that closes itself.
class UdpSocket {
 public:
  UdpSocket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (descriptor_ < 0) {
      throw Failure(fmt::format("doctor: no UDP socket can be opened: {}", std::strerror(errno)));
    }
  }
  ~UdpSocket() { close(descriptor_); }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int descriptor() const { return descriptor_; }
  void Set(int option, int value) { setsockopt(descriptor_, SOL_SOCKET, option, &value, sizeof value); }

 private:
  int descriptor_;
};

sockaddr_in Address(const std::string& group, uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, group.c_str(), &address.sin_addr);
  return address;
}

Finding CheckRoute(const MulticastEndpoint& endpoint) {
  const UdpSocket udp;
  const sockaddr_in address = Address(endpoint.group, endpoint.port);
  if (connect(udp.descriptor(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return {"multicast_route", Health::kFailure,
            fmt::format("no route to {}: {}", endpoint.group, std::strerror(errno)),
            "ip route add 224.0.0.0/4 dev lo"};
  }
  return {"multicast_route", Health::kGood, "to " + endpoint.group};
}

/// A training beside other programs: on the next port.
std::string TrainElsewhere(const LcmUrl& url) {
  if (!url.multicast) {
    return fmt::format("{} train --lcm-url '{}' --set run.channel_prefix=OTHER", ProgramName(), url.text);
  }
  const uint16_t port = url.multicast->port;
  const std::string old_port = fmt::format(":{}?", port);
  std::string next = url.text;
  next.replace(next.find(old_port), old_port.size(), fmt::format(":{}?", port == 65'535 ? 1024 : port + 1));
  return fmt::format("{} train --lcm-url '{}'", ProgramName(), next);
}

Finding CheckPort(const LcmUrl& url) {
  const MulticastEndpoint& endpoint = *url.multicast;
  UdpSocket udp;
  udp.Set(SO_REUSEADDR, 1);  // as LCM does
  const sockaddr_in address = Address("0.0.0.0", endpoint.port);
  if (bind(udp.descriptor(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return {"port", Health::kFailure,
            fmt::format("UDP port {} can't be used: {} (`ss -ulpn` shows who has it)", endpoint.port,
                        std::strerror(errno)),
            TrainElsewhere(url)};
  }
  return {"port", Health::kGood, fmt::format("UDP port {} can be shared", endpoint.port)};
}

Finding CheckBuffer(const MulticastEndpoint& endpoint) {
  UdpSocket udp;
  udp.Set(SO_RCVBUF, endpoint.receive_buffer_bytes);
  int granted = 0;
  socklen_t size = sizeof granted;
  getsockopt(udp.descriptor(), SOL_SOCKET, SO_RCVBUF, &granted, &size);
  granted /= 2;  // the kernel counts twice of what it was asked for
  if (granted < endpoint.receive_buffer_bytes) {
    return {"receive_buffer", Health::kWarning,
            fmt::format("{} bytes of the {} asked for, so that bursts are lost and sent again", granted,
                        endpoint.receive_buffer_bytes),
            fmt::format("sysctl -w net.core.rmem_max={}", endpoint.receive_buffer_bytes)};
  }
  return {"receive_buffer", Health::kGood, fmt::format("{} bytes", granted)};
}

Finding CheckReach(const MulticastEndpoint& endpoint) {
  return {"reach", Health::kGood,
          endpoint.ttl == 0
              ? "ttl=0: only this machine hears the run; with ttl=1 in --lcm-url, its network does"
          : endpoint.ttl == 1 ? "ttl=1: this machine's network hears the run"
                              : fmt::format("ttl={}: the run crosses routers", endpoint.ttl)};
}

/// Listens for a while: other runs on this port would be heard, and hear this one.
Finding CheckOtherTraffic(const DoctorOptions& options) {
  constexpr int64_t kListenUs = 1'200'000;  // a run announces itself every half second
  const std::string announcements_channel = ChannelsWithPrefix(options.channel_prefix).run;
  const auto bus = OpenLcmBus(options.lcm_url);
  int64_t messages = 0;
  int64_t announcements = 0;
  bus->SubscribeToAll([&](const LcmEvent& event) {
    ++messages;
    announcements += event.channel == announcements_channel ? 1 : 0;
  });
  for (const int64_t end_us = MonotonicMicroseconds() + kListenUs; MonotonicMicroseconds() < end_us;) {
    bus->Poll(end_us - MonotonicMicroseconds());
  }
  if (announcements > 0) {
    return {"other_traffic", Health::kWarning, "another run is on this bus; a second one is refused",
            TrainElsewhere(ParseLcmUrl(options.lcm_url))};
  }
  return {"other_traffic", Health::kGood,
          messages == 0 ? "none" : fmt::format("{} messages in 1.2 s, of no run", messages)};
}

/// Sends messages as large as Fresco's to itself, at a rate beyond that of a usual training.
Finding CheckDelivery(const DoctorOptions& options) {
  constexpr int kMessages = 10'000;
  constexpr int64_t kMessagesPerSecond = 20'000;
  const std::string channel = options.channel_prefix + "_DOCTOR";
  const int64_t own = DrawIdentifier();  // another doctor may be at work
  const auto receiver = OpenLcmBus(options.lcm_url);
  const auto sender = OpenLcmBus(options.lcm_url);
  int received = 0;
  std::vector<std::byte> message(1350);
  std::memcpy(message.data(), &own, sizeof own);
  receiver->Subscribe(channel, [&](std::span<const std::byte> heard) {
    received += std::equal(heard.begin(), heard.end(), message.begin(), message.end()) ? 1 : 0;
  });
  const int64_t begin_us = MonotonicMicroseconds();
  for (int sent = 0; sent < kMessages; ++sent) {
    const int64_t due_us = begin_us + sent * int64_t{1'000'000} / kMessagesPerSecond;
    do {
      receiver->Poll(std::max<int64_t>(due_us - MonotonicMicroseconds(), 0));
    } while (MonotonicMicroseconds() < due_us);
    sender->Publish(channel, message);
  }
  const double rate = kMessages / (1e-6 * static_cast<double>(MonotonicMicroseconds() - begin_us));
  while (received < kMessages && receiver->Poll(200'000) > 0) {
  }
  const double lost = 1 - static_cast<double>(received) / kMessages;
  if (received == 0) {
    return {"delivery", Health::kFailure, "no message came back; a firewall drops multicast, most likely",
            kAcceptMulticast};
  }
  const std::string found = fmt::format("{:.2f} % of {} messages of 1350 bytes lost at {:.0f} a second",
                                        100 * lost, kMessages, rate);
  if (lost > 0.01) {
    return {"delivery", Health::kWarning, found,
            "sysctl -w net.core.rmem_max=4194304 net.core.rmem_default=4194304"};
  }
  return {"delivery", Health::kGood, found};
}

/// What is wrong between this host and an actor's, if anything.
Finding CheckActor(const ProbedActor& actor, const ProbeResult& probes) {
  constexpr double kTolerableLoss = 0.01;
  constexpr double kTolerableSkewS = 1;  // log times mix, and recorded runs are told by their age
  if (actor.received == 0) {
    return {"host " + actor.host, Health::kWarning,
            fmt::format("actor {} is heard, but answers none of {} messages: its host has a firewall, a URL "
                        "with ttl=0 is "
                        "used here, or its --key-file is another one",
                        actor.pid, probes.sent),
            kAcceptMulticast};
  }
  const double lost_there = std::max(0.0, 1 - static_cast<double>(actor.received) / probes.sent);
  const double lost_here =
      std::max(0.0, 1 - static_cast<double>(actor.answers) / std::max(actor.received, 1));
  Finding finding{
      "host " + actor.host, Health::kGood,
      fmt::format("actor {}: of {} messages at {:.0f} a second {:.2f} % lost on the way there, {:.2f} % on "
                  "the way back; round trip {:.2f} ms; clock {:+.3f} s",
                  actor.pid, probes.sent, probes.sent_per_s, 100 * lost_there, 100 * lost_here,
                  actor.round_trip_ms, actor.clock_ahead_s)};
  if (lost_there > kTolerableLoss || lost_here > kTolerableLoss) {
    finding.health = Health::kWarning;
    const std::string where = lost_there > lost_here ? "on " + actor.host : "on this host";
    finding.found += "; more buffer may help, " + where;
    finding.command = "sysctl -w net.core.rmem_max=4194304 net.core.rmem_default=4194304";
  } else if (std::abs(actor.clock_ahead_s) > kTolerableSkewS) {
    finding.health = Health::kWarning;
    finding.found += "; set the clock of the host that is wrong";
    finding.command = "timedatectl set-ntp true";
  }
  return finding;
}

/// Which hosts with an actor hear this one, and are heard.
std::vector<Finding> CheckHosts(const DoctorOptions& options) {
  ProbeOptions probe = options.probe;
  probe.lcm_url = options.lcm_url;
  probe.channel_prefix = options.channel_prefix;
  const ProbeResult probes = ProbeActors(probe);
  std::vector<Finding> findings;
  for (const ProbedActor& actor : probes.actors) {
    findings.push_back(CheckActor(actor, probes));
  }
  if (findings.empty()) {
    std::string url = ParseLcmUrl(options.lcm_url).text;
    if (const size_t stays_here = url.rfind("ttl=0"); stays_here != std::string::npos) {
      url.replace(stays_here, 5, "ttl=1");
    }
    findings.push_back(
        {"hosts", Health::kWarning,
         fmt::format(
             "no actor answered {} messages; start one on each of the other hosts, and use a URL with "
             "ttl=1 or more on all hosts",
             probes.sent),
         fmt::format("fresco-actor --lcm-url '{}'", url)});
  }
  return findings;
}

Finding CheckProcessor() {
  const std::string name = CurrentArithmetic().name;
  return {"processor", Health::kGood,
          fmt::format("{}; the bits are those of every other host{}", name,
                      name == "portable" ? ", but networks are many times slower" : "")};
}

Finding CheckMemory() {
  constexpr int64_t kUsual = 500'000'000;  // a training with a ready experiment
  const AvailableMemory memory = ReadAvailableMemory();
  const std::string found =
      fmt::format("{} available ({})", BytesText(memory.host.bytes), memory.host.source);
  if (memory.host.bytes < kUsual) {
    return {"memory", Health::kWarning, found + "; the ready experiments need up to 500 MB",
            fmt::format("{} train --set agent.replay_capacity=40000", ProgramName())};
  }
  return {"memory", Health::kGood, found};
}

Finding CheckDisk(const std::string& folder) {
  constexpr int64_t kUsual = 1'000'000'000;  // checkpoints, pictures, a recorded log
  constexpr int64_t kLeast = 50'000'000;
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error) {
    return {"disk", Health::kFailure, fmt::format("{}: {}", folder, error.message()),
            fmt::format("mkdir -p '{}'", folder)};
  }
  const auto free_bytes = static_cast<int64_t>(space.available);
  const std::string found = fmt::format("{} free", BytesText(free_bytes));
  if (free_bytes < kUsual) {
    return {"disk", free_bytes < kLeast ? Health::kFailure : Health::kWarning,
            found + "; a run with its log takes up to 1 GB",
            fmt::format("{} train --out /other/disk/NAME", ProgramName())};
  }
  return {"disk", Health::kGood, found};
}

/// Whether a function that says what a command needs throws nothing.
template <class Require>
Finding CheckProgram(const std::string& name, const std::string& purpose, const std::string& command,
                     Require require) {
  try {
    require();
  } catch (const Error& error) {
    return {name, Health::kWarning, error.what(), command};
  }
  return {name, Health::kGood, "installed: " + purpose};
}

std::vector<Finding> Examine(const DoctorOptions& options) {
  std::vector<Finding> findings;
  const LcmUrl url = ParseLcmUrl(options.lcm_url);
  ChannelsWithPrefix(options.channel_prefix);  // throws if there are no such channels
  if (url.text == "memq://") {
    throw UsageError(
        "doctor: expected a URL that several processes share, udpm:// or tcpq://; found memq://");
  }
  bool bus_works = true;
  const auto add = [&](Finding finding) {
    bus_works &= finding.health != Health::kFailure;
    findings.push_back(std::move(finding));
  };
  if (url.multicast) {
    add(CheckRoute(*url.multicast));
    add(CheckPort(url));
    add(CheckBuffer(*url.multicast));
    add(CheckReach(*url.multicast));
  }
  if (bus_works) {  // the checks before say why it can't
    try {
      add(CheckOtherTraffic(options));
      if (findings.back().health == Health::kGood) {  // a run is not to be disturbed
        add(CheckDelivery(options));
      }
    } catch (const Error& error) {
      add({"delivery", Health::kFailure, error.what(), url.multicast ? kAcceptMulticast : ""});
    }
  }
  if (bus_works && options.hosts) {
    for (Finding& finding : CheckHosts(options)) {
      add(std::move(finding));
    }
  }
  add(CheckProcessor());
  add(CheckMemory());
  add(CheckDisk(options.folder));
  add(CheckProgram("gnuplot", "draws the report's curves", "apt-get install -y gnuplot-nox",
                   [] { RequireProgram("gnuplot", "gnuplot-nox"); }));
  const bool in_source_tree = ProgramName().ends_with("tools/fresco");
  add(CheckProgram("lcm_spy", "shows a live run (fresco spy)",
                   in_source_tree ? ProgramName() + " spy" : "apt-get install -y ./fresco-spy_*.deb",
                   RequireSpy));
  return findings;
}

const char* NameOf(Health health) {
  return health == Health::kGood ? "good" : health == Health::kWarning ? "warning" : "failure";
}

int Doctor(const DoctorOptions& options) {
  const std::vector<Finding> findings = Examine(options);
  bool works = true;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (const auto& [name, health, found, command] : findings) {
    works &= health != Health::kFailure;
    list.push_back({{"name", name}, {"health", NameOf(health)}, {"found", found}});
    list.back()["command"] = command.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(command);
    text += fmt::format("{:<8} {:<16} {}\n", NameOf(health), name, found);
    if (!command.empty()) {
      text += fmt::format("{:<25} mend it: {}\n", "", command);
    }
  }
  if (options.format == "json") {
    fmt::print("{}\n", nlohmann::ordered_json{{"works", works}, {"findings", list}}.dump(
                           2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    fmt::print("{}\n{}\n", text,
               works ? "Training works on this machine." : "Training can't work on this machine.");
  }
  return works ? 0 : 1;
}

}  // namespace

void AddDoctor(CLI::App& app, Command& command) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* doctor = app.add_subcommand(
      "doctor",
      "Examine this machine: network, memory, disk, programs; each problem with the command that mends it");
  doctor->add_option("--lcm-url", options->lcm_url, "LCM URL of the runs to come")
      ->type_name("URL")
      ->capture_default_str();
  doctor->add_option("--channel-prefix", options->channel_prefix, "First part of the channels' names")
      ->type_name("PREFIX")
      ->capture_default_str();
  doctor->add_option("--folder", options->folder, "Where runs will be written")
      ->type_name("FOLDER")
      ->capture_default_str();
  CLI::Option* hosts = doctor->add_flag(
      "--hosts", options->hosts,
      "Also ask the actors on the bus, on any host, for answers: who hears whom, losses, clocks");
  doctor
      ->add_option("--rate", options->probe.messages_per_s, "Messages a second that each actor has to answer")
      ->capture_default_str()
      ->needs(hosts)
      ->check(CLI::Range(1, 10'000));
  AddKeyFileOption(*doctor, options->probe.key_file)->needs(hosts);
  doctor->add_option("--format", options->format, "How the result is printed")
      ->check(OneOf({"text", "json"}));
  doctor->footer(
      HelpExamples({"fresco doctor", "fresco doctor --hosts --lcm-url 'udpm://239.255.76.67:7667?ttl=1'"}) +
      "\n\nExit status: 0 training works, 1 it can't.");
  doctor->callback([options, &command] { command = [options] { return Doctor(*options); }; });
}

}  // namespace fresco
