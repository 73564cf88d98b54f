#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "bus/bus.h"
#include "bus/lcm_url.h"
#include "core/error.h"
#include "core/help_formatter.h"
#include "core/installation.h"
#include "msgs/channels.h"
#include "tools/subcommands.h"

namespace fresco {
namespace {

/// What `all` opens. Java then opens flight or episode, whichever fits the world (Windows.java).
const std::vector<std::string> kAllWindows = {"fitting", "learner", "actors"};

struct SpyOptions {
  std::string lcm_url = kDefaultLcmUrl;
  std::string channel_prefix = kDefaultChannelPrefix;
  std::vector<std::string> open;
  bool print_table = false;
};

constexpr char kJavaPackages[] = "default-jre liblcm-java libjchart2d-java";

/// Returns the path of a jar of a Debian package or of LCM's own installation.
std::string SystemJar(const std::string& name) {
  for (const char* folder : {"/usr/share/java/", "/usr/local/share/java/"}) {
    if (std::filesystem::exists(folder + name)) {
      return folder + name;
    }
  }
  throw UsageError(fmt::format("spy: expected /usr/share/java/{}, found none; install it: apt-get install {}",
                               name, kJavaPackages));
}

/// Returns the path of a jar that is part of Fresco.
std::string OwnJar(const std::string& name) {
  const std::filesystem::path path = SharedFolder() / name;
  if (!std::filesystem::exists(path)) {
    throw UsageError(
        fmt::format("spy: expected {}, found none; in the source tree, tools/fresco spy installs a Java "
                    "development kit and builds it; cmake --install then installs it",
                    path.string()));
  }
  return path.string();
}

/// Returns one class path for all jars, since lcm-spy accepts viewers only from the class loader of the
/// messages.
std::string ClassPath() {
  return fmt::format("{}:{}:{}:{}", SystemJar("lcm.jar"), SystemJar("jchart2d.jar"),
                     OwnJar("fresco_types.jar"), OwnJar("fresco_spy.jar"));
}

void RequireDisplay() {
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0') {
    throw UsageError(
        "spy: expected an X display in the environment variable DISPLAY, found none; run it on a desktop, "
        "over ssh -X, or under xvfb-run");
  }
}

/// Warns if the system's receive buffer is small. Java's LCM uses that, whatever the URL says.
void WarnOfSmallReceiveBuffer() {
  constexpr int64_t kEnoughBytes = 1 << 20;  // room for all chunks of a network, with the kernel's overhead
  int64_t bytes = kEnoughBytes;
  std::ifstream("/proc/sys/net/core/rmem_default") >> bytes;
  if (bytes < kEnoughBytes) {
    spdlog::warn(
        "spy: Java receives with the system's buffer of {} bytes, so it may miss messages of a fast run; as "
        "root: sysctl -w net.core.rmem_default=4194304",
        bytes);
  }
}

std::vector<std::string> JavaCommand(const SpyOptions& options) {
  return {"java",
          "-Djava.net.preferIPv4Stack=true",
          "-Xmx512m",
          "-cp",
          ClassPath(),
          "fresco.spy.Main",
          ParseLcmUrl(options.lcm_url).text,
          options.channel_prefix,
          fmt::format("{}", fmt::join(options.open, ",")),
          options.print_table ? "true" : "false"};
}

/// Replaces this process by Java, so that lcm-spy itself receives signals and sets the exit status.
int Spy(SpyOptions options) {
  ChannelsWithPrefix(options.channel_prefix);
  OpenLcmBus(options.lcm_url);  // throws if that fails; Java's LCM would try again for ever
  RequireDisplay();
  RequireSpy();
  if (options.open == std::vector<std::string>{"all"}) {
    options.open = kAllWindows;
  }
  const std::vector<std::string> command = JavaCommand(options);
  WarnOfSmallReceiveBuffer();
  std::vector<char*> arguments;
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  throw Failure(fmt::format("spy: java can't be run: {}", std::strerror(errno)));
}

}  // namespace

void RequireSpy() {
  RequireProgram("java", "default-jre");
  ClassPath();
}

void AddSpy(CLI::App& app, Command& command) {
  auto options = std::make_shared<SpyOptions>();
  CLI::App* spy = app.add_subcommand("spy", "Watch a run's messages, flights and curves in lcm-spy");
  spy->add_option("--lcm-url", options->lcm_url, "LCM URL of the run")
      ->type_name("URL")
      ->capture_default_str();
  spy->add_option("--channel-prefix", options->channel_prefix, "First part of the channels' names")
      ->type_name("PREFIX")
      ->capture_default_str();
  spy->add_option("--open", options->open,
                  "Open these windows at once: flight,episode,learner,actors, or all: learner, actors, and "
                  "whichever of flight and episode fits the world")
      ->delimiter(',')
      ->check(OneOf({"flight", "episode", "learner", "actors", "all"}));
  spy->add_flag("--print-table", options->print_table,
                "Also print the table once a second: channel, type, messages received, damaged messages");
  spy->footer(HelpExamples({"fresco spy --open all"}));
  spy->callback([options, &command] { command = [options] { return Spy(*options); }; });
}

}  // namespace fresco
