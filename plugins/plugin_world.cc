#include "plugins/plugin_world.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "core/bytes.h"
#include "core/child_process.h"
#include "core/error.h"
#include "core/files.h"
#include "core/installation.h"
#include "worlds/episode.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// A file in memory that a child process writes to.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("fresco", 0)) {
    if (descriptor_ < 0) {
      throw Failure("can't make a file in memory");
    }
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }
  std::string text() const { return ReadFile(fmt::format("/proc/self/fd/{}", descriptor_)); }

 private:
  int descriptor_;
};

/// What a program said went wrong: its last line, without the program's name.
std::string Complaint(const std::string& errors) {
  std::string text = errors.substr(0, errors.find_last_not_of('\n') + 1);
  text = text.substr(text.rfind('\n') + 1);
  const std::string mark = "error: ";
  const size_t found = text.find(mark);
  return found == std::string::npos ? text : text.substr(found + mark.size());
}

PluginDescription Ask(const PluginSpec& spec) {
  constexpr int kCalls = 5;  // each has its own limit
  constexpr double kStartS = 10;
  const MemoryFile output;
  const MemoryFile errors;
  ChildProcess program({SiblingProgram("fresco-world").string(), "describe", "--library", spec.library,
                        "--settings", spec.settings, "--call-limit-s", fmt::format("{}", spec.call_limit_s)},
                       {STDIN_FILENO, output.descriptor(), errors.descriptor()});
  const auto limit_us = static_cast<int64_t>(1e6 * (kStartS + kCalls * spec.call_limit_s));
  const std::optional<int> status = program.Wait(limit_us);
  if (!status) {
    throw UsageError(fmt::format("plugin.library: {}: did not say in time what its world is", spec.library));
  }
  if (*status != 0) {
    const std::string complaint = Complaint(errors.text());
    throw UsageError(complaint.empty() ? fmt::format("plugin.library: {}: fresco-world ended with status {}",
                                                     spec.library, *status)
                                       : complaint);
  }
  return PluginDescriptionFrom(output.text());
}

}  // namespace

PluginDescription DescribePlugin(const PluginSpec& spec) {
  using Key = std::tuple<std::string, std::string, uint32_t>;
  static std::mutex mutex;
  static std::map<Key, PluginDescription> known;
  const Key key{spec.library, spec.settings, CodeCrc(spec.library, "plugin.library")};
  const std::lock_guard lock(mutex);
  const auto found = known.find(key);
  return found != known.end() ? found->second : known.emplace(key, Ask(spec)).first->second;
}

std::string ToJson(const PluginDescription& description) {
  const WorldDescription& world = description.world;
  OrderedJson json = {{"name", world.name}, {"state", OrderedJson::array()}, {"actions", world.actions}};
  for (const Quantity& field : world.state) {
    json["state"].push_back({{"name", field.name}, {"unit", field.unit}});
  }
  json["longest_episode"] = world.longest_episode;
  json["discount"] = world.discount;
  json["success"] = world.success;
  json["success_return"] = description.success_return;
  json["without_chance"] = !world.random;
  return json.dump(2);
}

PluginDescription PluginDescriptionFrom(const std::string& text) {
  try {
    const OrderedJson json = OrderedJson::parse(text);
    PluginDescription description;
    WorldDescription& world = description.world;
    world.name = json.at("name");
    for (const OrderedJson& field : json.at("state")) {
      world.state.push_back({field.at("name"), field.at("unit")});
    }
    world.actions = json.at("actions").get<std::vector<std::string>>();
    world.observation_size = static_cast<int>(world.state.size());
    world.longest_episode = json.at("longest_episode");
    world.discount = json.at("discount");
    world.repeatable = false;
    world.random = !json.at("without_chance").get<bool>();
    world.chance = world.random;
    world.figures = {{"return", ""}};
    world.success = json.at("success");
    description.success_return = json.at("success_return");
    return description;
  } catch (const nlohmann::json::exception& error) {
    throw UsageError(fmt::format("fresco-world: its answer can't be read: {}", error.what()));
  }
}

PluginWorld::PluginWorld(PluginSpec spec, PluginDescription description)
    : World(std::move(description.world)),
      spec_(std::move(spec)),
      success_return_(description.success_return) {}

std::unique_ptr<Environment> PluginWorld::NewEnvironment() const {
  const std::lock_guard lock(mutex_);
  if (library_ == nullptr) {
    library_ = std::make_unique<PluginLibrary>(spec_);
  }
  return library_->NewEnvironment();
}

void PluginWorld::Observe(std::span<const float> state, std::span<float> observation) const {
  std::copy(state.begin(), state.end(), observation.begin());
}

std::optional<StateFormulas> PluginWorld::Formulate(Formulas& formulas) const {
  return StateFormulas{formulas.State(0, state_size()), std::nullopt};  // the mask is the library's
}

bool PluginWorld::Succeeded(const Episode& episode) const {
  return Return(episode) >= success_return_;
}

uint32_t CodeCrc(const std::string& path, const std::string& field) {
  try {
    const std::string content = ReadFile(path);
    return std::max(Crc32c(std::as_bytes(std::span(content))), 1u);
  } catch (const Error& error) {
    throw UsageError(fmt::format("{}: {}", field, error.what()));
  }
}

}  // namespace fresco
