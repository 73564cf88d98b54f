#include "msgs/plugin_config.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "core/installation.h"
#include "plugins/plugin_world.h"

namespace fresco {
namespace {

/// Returns the CRC-32C of the code, which has to be `expected` unless that is 0.
uint32_t CheckedCrc(const std::string& path, const std::string& field, uint32_t expected) {
  const uint32_t found = CodeCrc(path, field);
  if (expected != 0 && found != expected) {
    throw UsageError(
        fmt::format("{}: {} has the CRC-32C {:08x}, the run's has {:08x}; every host of a run needs "
                    "the same file",
                    field, path, found, expected));
  }
  return found;
}

/// The module of module:Class. Throws UsageError if the object is not of this form.
std::string ModuleOf(const std::string& object) {
  const size_t colon = object.find(':');
  if (colon == 0 || colon == std::string::npos || colon + 1 == object.size()) {
    throw UsageError(
        fmt::format("python.object: expected module:Class, e.g. cartpole:CartPole; found \"{}\"", object));
  }
  return object.substr(0, colon);
}

std::shared_ptr<const World> MakeFrom(const PluginSpec& spec) {
  return std::make_shared<PluginWorld>(spec, DescribePlugin(spec));
}

}  // namespace

void CompletePlugin(proto::ExperimentConfig& config) {
  proto::Plugin& plugin = *config.mutable_plugin();
  if (plugin.library().empty()) {
    throw UsageError("plugin.library: expected the path of a shared library, found none");
  }
  plugin.set_library_crc32c(CheckedCrc(plugin.library(), "plugin.library", plugin.library_crc32c()));
}

void CompletePython(proto::ExperimentConfig& config) {
  proto::Python& python = *config.mutable_python();
  python.set_module_crc32c(CheckedCrc(PythonCode(config), "python.object", python.module_crc32c()));
}

std::shared_ptr<const World> MakePluginWorld(const proto::ExperimentConfig& config) {
  const proto::Plugin& plugin = config.plugin();
  return MakeFrom({plugin.library(), plugin.settings(), plugin.call_limit_s()});
}

std::shared_ptr<const World> MakePythonWorld(const proto::ExperimentConfig& config) {
  const proto::Python& python = config.python();
  const std::filesystem::path library = LibraryFolder() / "python_world.so";
  if (!std::filesystem::exists(library)) {
    throw UsageError(fmt::format(
        "python: expected the library {}, found none; build or install all of Fresco", library.string()));
  }
  const std::string settings =
      fmt::format("{}\n{}\n{}\n{}", python.object(), std::filesystem::absolute(python.path()).string(),
                  python.maximum_steps(), python.success_return());
  try {
    return MakeFrom({library.string(), settings, python.call_limit_s()});
  } catch (const Error& error) {  // it speaks of the library, which is ours
    const std::string text = error.what();
    const std::string mark = library.string() + ": ";
    const size_t found = text.find(mark);
    throw UsageError(fmt::format("python.object: {}: {}", python.object(),
                                 found == std::string::npos ? text : text.substr(found + mark.size())));
  }
}

std::string PluginCode(const proto::ExperimentConfig& config) {
  return config.plugin().library();
}

std::string PythonCode(const proto::ExperimentConfig& config) {
  std::string module = ModuleOf(config.python().object());
  for (char& character : module) {
    character = character == '.' ? '/' : character;
  }
  return (std::filesystem::path(config.python().path()) / (module + ".py")).string();
}

}  // namespace fresco
